// SPDX-License-Identifier: BSD-3-Clause
// An endless walk over the places of a floor plan. It prefers the passages that it has taken least, so that
// it visits all places, closes rings and takes corridors in both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/floor_plan.h"
#include "simulation/simulation_random.h"

namespace psi_slam {

class Route {
 public:
  /// Starts at a crossing. The plan must outlive the route.
  Route(const FloorPlan& plan, std::uint64_t seed);

  /// Returns the first place, then the next place at each call. A passage links successive places.
  std::size_t next();

 private:
  struct Way {
    std::size_t to = 0;
    std::size_t back = 0;  ///< index of the opposite way in the ways from `to`
    double taken = 0;      ///< how often
  };

  double reluctance(const Way& way);

  const FloorPlan& plan_;
  SimulationRandom random_;
  std::vector<std::vector<Way>> ways_;  ///< by start place
  std::size_t here_ = 0;
  std::size_t before_ = 0;
  bool started_ = false;
};

}  // namespace psi_slam
