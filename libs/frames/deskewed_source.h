// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Returns the scan that the laser would have measured from its pose at the first beam if the robot had stood
/// still. `motion` is the robot's pose at the last beam relative to its pose at the first; the beams are
/// evenly spread over this motion. Each beam keeps its index and gets the range and bearing of its end point.
/// The bearing of a beam without a return turns with the robot. All beams of the result start at the laser's
/// first position. The free space along them is therefore a few centimetres off.
LaserScan deskewed(const LaserScan& scan, const mrpt::math::TPose2D& motion);

/// Removes the robot's motion during a sweep from the scans of another source. Takes the motion from odometry
/// between a scan and the next scan of the same laser, else from the previous scan to this scan. Leaves scans
/// without odometry unchanged. Ignores a neighbouring scan that is more than one second away, or less than
/// two thirds of the sweep time.
class DeskewedSource : public FrameSource {
 public:
  /// `sweep_time_s`, seconds, replaces the sweep time of all scans. If it is empty, the sweep time of each
  /// scan applies.
  DeskewedSource(std::unique_ptr<FrameSource> source, std::optional<double> sweep_time_s);

  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

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
  void straighten(LaserScan& scan, const Mark& mark, const Marks& next_marks) const;

  std::unique_ptr<FrameSource> source_;
  std::optional<double> sweep_time_s_;
  bool started_ = false;
  Marks last_marks_;
  std::optional<Frame> ahead_;
  std::exception_ptr failure_;  // error of reading ahead; thrown after the last frame before the error
};

}  // namespace psi_slam
