// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_closure_factor.h"

#include <numeric>

#include "base/portable_math.h"

namespace psi_slam {

void LoopClosureFactor::move(double odometry_m, const mrpt::math::TPoint2D& robot) {
  if (!start_) start_ = robot;
  from_start_m_ = portable::hypot(robot.x - start_->x, robot.y - start_->y);
  path_m_ += odometry_m;
}

LoopClosureFactor::Value LoopClosureFactor::value() const {
  Value value;
  // The comparison uses a product, because the quotient is infinite or 0 / 0 at the start.
  value.eta = path_m_ >= options_.eta_max * from_start_m_ ? options_.eta_max : path_m_ / from_start_m_;
  if (!loops_.empty())
    value.mean_loops =
        std::accumulate(loops_.begin(), loops_.end(), 0.0) / static_cast<double>(loops_.size());
  value.psi = value.eta * value.mean_loops;
  return value;
}

void LoopClosureFactor::add_search(int loops) {
  loops_.push_back(loops);
  if (loops_.size() > static_cast<std::size_t>(options_.window_frames)) loops_.pop_front();
}

}  // namespace psi_slam
