// SPDX-License-Identifier: BSD-3-Clause
// People who walk up and down the corridors. Their positions depend only on the time.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <cstdint>
#include <vector>

#include "simulation/floor_plan.h"

namespace psi_slam {

inline constexpr double kPersonRadius_m = 0.2;

class WalkingPeople {
 public:
  WalkingPeople(const FloorPlan& plan, std::size_t count, std::uint64_t seed);

  /// Centres of the people in the plan, in metres.
  std::vector<mrpt::math::TPoint2D> at(double time_s) const;

 private:
  /// Walks between two points, back and forth.
  struct Person {
    mrpt::math::TPoint2D from;
    mrpt::math::TPoint2D to;
    double speed_m_s = 1;
    double start_m = 0;  ///< distance along the way at time 0
  };
  std::vector<Person> people_;
};

}  // namespace psi_slam
