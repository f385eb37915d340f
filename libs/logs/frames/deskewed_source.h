// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <exception>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/frame_source.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Returns the scan that the laser would have measured from its pose at the beam that is measured first if
/// the robot had stood still. `motion` is the robot's pose at the beam that is measured last, relative to its
/// pose at the beam that is measured first; the beams are evenly spread over this motion. A negative sweep
/// time of `scan` means that the last beam is measured first; otherwise the first beam is. Each beam keeps
/// its index and gets the range and bearing of its end point. The bearing of a beam without a return turns
/// with the robot. All beams of the result start at the laser's first position. The free space along them is
/// therefore a few centimetres off. The sweep time of the result is 0.
LaserScan deskewed(const LaserScan& scan, const mrpt::math::TPose2D& motion);

/// How long the sweeps of a log take, and in which order the beams are measured.
struct SweepTiming {
  std::optional<double> time_s;  ///< replaces the sweep time of all scans, seconds; the sign is kept
  SweepDirection direction = SweepDirection::kAuto;  ///< order of the beams of all lasers, set by the user
  /// Order of the beams of each laser, by its number; used if `direction` is kAuto. If the entry of a laser
  /// is kAuto or missing, the sign of the sweep time in its scans applies.
  std::vector<SweepDirection> directions{};
  std::vector<std::string> assumptions{};  ///< see FrameSource::assumptions()

  /// Returns the sweep time of a scan, seconds; negative: the last beam is measured first.
  double sweep_time_s(const LaserScan& scan) const;
};

/// Removes the robot's motion during a sweep from the scans of another source. Takes the motion from odometry
/// between a scan and the next scan of the same laser, else from the previous scan to this scan. Ignores a
/// neighbouring scan that is more than one second away, or less than two thirds of the sweep time. Scans
/// without odometry keep their beams, and get the sweep time of the SweepTiming. Only a frame with a sweep
/// time waits for the next one.
class DeskewedSource : public FrameSource {
 public:
  DeskewedSource(std::unique_ptr<FrameSource> source, SweepTiming timing);

  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override;

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
  std::optional<Frame> read();
  bool is_bent(const LaserScan& scan) const;
  void straighten(LaserScan& scan, const Mark& mark, const Marks& next_marks) const;

  std::unique_ptr<FrameSource> source_;
  SweepTiming timing_;
  bool ended_ = false;
  Marks last_marks_;
  std::optional<Frame> ahead_;  // read to learn the motion during the frame before
  std::exception_ptr failure_;  // error of reading ahead; thrown after the last frame before the error
};

}  // namespace psi_slam
