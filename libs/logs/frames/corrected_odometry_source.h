// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "logs/frames/odometry_track.h"
#include "psi_slam/frame_source.h"

namespace psi_slam {

/// Corrects the odometry of another source whose frames hold one scan each. Multiplies distances by a scale.
/// Gives each scan the odometry of the time at which it was measured: its time stamp minus the delay of its
/// laser. That pose is interpolated between the scans of all lasers around this time. Scans that were
/// measured before the first scan of the log keep its pose. Frames keep their order, number and time stamp,
/// and the heading of a gyroscope. Frames without odometry stay unchanged.
class CorrectedOdometrySource : public FrameSource {
 public:
  /// Maximum number of frames that wait for later odometry: those of the largest delay at 100 Hz. Frames
  /// whose clock stands still would otherwise wait for the end of the log.
  static constexpr std::size_t kMaxWaiting = 60'000;

  /// Returns the delay of a laser, seconds, by its number (LaserScan::laser). Called after the first scan of
  /// the laser was read.
  using DelayOfLaser = std::function<double(std::size_t laser)>;

  CorrectedOdometrySource(std::unique_ptr<FrameSource> source, double scale, DelayOfLaser delay_s);

  /// Returns the next frame. Delivers all buffered frames, then rethrows the source's error.
  std::optional<Frame> next() override;

  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override { return source_->skipped_lines(); }
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  void read_ahead();
  void find_delay(std::size_t laser);
  TimeUs delay_us(const Frame& frame) const { return delays_us_.at(frame.scan.laser); }
  bool must_wait(const Frame& frame) const;
  void correct(Frame& frame) const;

  std::unique_ptr<FrameSource> source_;
  double scale_;
  DelayOfLaser delay_s_;
  std::map<std::size_t, TimeUs> delays_us_;  // of the lasers that have been read
  OdometryTrack track_;
  std::deque<Frame> waiting_;
  std::size_t corrected_ = 0;  // number of waiting frames whose odometry is final
  bool ended_ = false;
  std::exception_ptr failure_;  // error of reading ahead; thrown after the last frame before the error
};

}  // namespace psi_slam
