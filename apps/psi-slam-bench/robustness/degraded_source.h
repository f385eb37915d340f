// SPDX-License-Identifier: BSD-3-Clause
// A log made worse, to see what a program makes of it: fewer scans, a narrower laser, noisier odometry or
// none.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>

#include "base/random_draws.h"
#include "psi_slam/frame_source.h"
#include "robustness/odometry_noise.h"

namespace psi_slam {

struct DegradationOptions {
  /// Odometry's error becomes about so many times its natural one, which is `natural_noise`: to each step
  /// between scans of the log, normal noise of sqrt(scale^2 - 1) times that is added, whose variance grows
  /// with the step's way and turn. 1 or less leaves odometry as it is.
  double odometry_noise_scale = 1;
  OdometryNoise natural_noise;
  std::size_t keep_every_nth = 1;           ///< scans, from the first on; the others are not there at all
  std::optional<double> field_of_view_rad;  ///< straight ahead of the laser; beams beside it are no returns
  bool no_odometry = false;                 ///< frames say that they have none
  std::uint64_t seed = 1;                   ///< of the noise
};

class DegradedSource : public FrameSource {
 public:
  /// Throws std::invalid_argument when no scan would be kept, or the field of view is not positive.
  DegradedSource(std::unique_ptr<FrameSource> source, const DegradationOptions& options);

  /// Numbered anew.
  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }

 private:
  void spoil_odometry(Frame& frame);
  void narrow(LaserScan& scan) const;

  std::unique_ptr<FrameSource> source_;
  DegradationOptions options_;
  RandomDraws draws_;
  std::size_t read_ = 0;
  std::size_t kept_ = 0;
  std::optional<mrpt::math::TPose2D> last_odom_T_robot_;  ///< of the log
  mrpt::math::TPose2D spoilt_odom_T_robot_;
};

}  // namespace psi_slam
