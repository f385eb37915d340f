// SPDX-License-Identifier: BSD-3-Clause
// Where a robot goes next: an endless walk over the places of a floor plan that takes the passages it has
// taken least, so that it comes by everywhere, closes rings, and goes every corridor both ways.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/floor_plan.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

class Route {
 public:
  /// Starts at a crossing. The plan outlives the route.
  Route(const FloorPlan& plan, std::uint64_t seed);

  /// The place where the walk stands, then each next one, which a passage links with the one before.
  std::size_t next();

 private:
  struct Way {
    std::size_t to = 0;
    std::size_t back = 0;  ///< the index of the way back, among those from `to`
    double taken = 0;      ///< times
  };

  double reluctance(const Way& way);

  const FloorPlan& plan_;
  SimulationRandom random_;
  std::vector<std::vector<Way>> ways_;  ///< by the place they start from
  std::size_t here_ = 0;
  std::size_t before_ = 0;
  bool started_ = false;
};

}  // namespace psi_slam
