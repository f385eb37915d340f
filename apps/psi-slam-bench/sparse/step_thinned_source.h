// SPDX-License-Identifier: BSD-3-Clause
// Thins a log by odometry, as many public logs are, and composes poses for the removed scans.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "map/trajectory/trajectory_file.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Step between kept scans: a scan is kept if, by odometry, the robot moved or turned at least this much
/// since the last kept scan.
struct ThinningStep {
  double distance_m = 1;
  double turn_rad = 0.5;
};

/// A scan of the original log, kept or removed.
struct ThinnedScan {
  TimeUs time_us = 0;
  std::size_t kept = 0;             ///< number of the last kept scan, from 0; this scan itself if it was kept
  mrpt::math::TPose2D kept_T_scan;  ///< motion of the robot since the last kept scan, by odometry
};

/// Source that keeps the first scan of another source, and each scan at least one step after the last kept
/// scan.
class StepThinnedSource : public FrameSource {
 public:
  /// Throws std::invalid_argument if a part of the step is negative or not finite.
  StepThinnedSource(std::unique_ptr<FrameSource> source, const ThinningStep& step);

  /// Next kept frame. Frame::index counts the kept frames. Throws UserError for a scan without odometry.
  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

  /// All scans read so far, in the order of the log.
  const std::vector<ThinnedScan>& scans() const { return scans_; }

 private:
  bool is_one_step(const mrpt::math::TPose2D& motion) const;

  std::unique_ptr<FrameSource> source_;
  ThinningStep step_;
  std::vector<ThinnedScan> scans_;
  mrpt::math::TPose2D odom_T_kept_;  ///< odometry of the last kept scan
  std::size_t kept_ = 0;             ///< number of kept scans
};

/// Poses of all scans of the original log: the pose of the last kept scan, composed with the odometry since.
/// Throws std::out_of_range if a kept scan has no pose.
Trajectory put_poses_back(const std::vector<ThinnedScan>& scans,
                          const std::vector<mrpt::math::TPose2D>& map_T_kept);

/// Selects the poses of the kept scans from the poses of all scans. Throws std::out_of_range if a pose is
/// missing.
std::vector<mrpt::math::TPose2D> poses_of_kept(const std::vector<ThinnedScan>& scans,
                                               const std::vector<mrpt::math::TPose2D>& map_T_scan);

}  // namespace psi_slam
