// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// The scan as the laser would have seen it from where it was at the first beam, had the robot stood still.
/// Beams are spread evenly over the sweep, in which the robot moved by `motion` (its last pose in the first).
/// Each beam keeps its place in the order and gets the range and bearing of its point; one without return
/// turns with the robot. Free space is drawn from the laser's place at the first beam: some centimetres off.
LaserScan deskewed(const LaserScan& scan, const mrpt::math::TPose2D& motion);

/// Takes the robot's motion out of the scans of another source. The motion while a laser turned is that from
/// the scan's odometry to that of the same laser's next, or where there is no later one, from the one before;
/// scans more than a second away from both stay as they are, and so do those without odometry.
class DeskewedSource : public FrameSource {
 public:
  /// Without a stated time of the sweep, each scan's own holds.
  DeskewedSource(std::unique_ptr<FrameSource> source, std::optional<double> sweep_time_s);

  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }

 private:
  struct Mark {
    std::size_t laser = 0;
    TimeUs time_us = 0;
    mrpt::math::TPose2D odom_T_robot;
    bool has_odometry = true;
  };

  using Marks = std::vector<Mark>;

  static Marks marks_of(const Frame& frame);
  static const Mark& mark_like(const Mark& mark, const Marks& marks);
  static std::optional<mrpt::math::TPose2D> motion_between(const Mark& from, const Mark& to, double time_s);
  std::optional<Frame> read_ahead();
  void straighten(LaserScan& scan, const Mark& mark, const Marks& behind) const;

  std::unique_ptr<FrameSource> source_;
  std::optional<double> sweep_time_s_;
  bool started_ = false;
  Marks before_;
  std::optional<Frame> ahead_;
  std::exception_ptr failure_;  // of reading ahead; told behind the frame in front of it
};

}  // namespace psi_slam
