// SPDX-License-Identifier: BSD-3-Clause
// Combines the scans of a robot's lasers into frames (scan synchronisation).
//
// Each scan of the first laser opens a frame. One scan of every other laser may join it if it is at most
// `kMaxApart_s` away in time. Odometry at both times gives the robot's motion between the two scans. If the
// motion exceeds `kMaxMotion_m` or `kMaxTurn_rad`, odometry has jumped, and the scan is dropped. Without
// odometry, the robot is taken to turn by the gyroscope between the two scans, or else to stand still.
//
// A scan belongs to the frame nearest in time. If lasers scan half a period apart, two scans of one laser
// often belong to the same frame. Then a scan about half-way to the next frame joins the next frame instead,
// although that frame is farther in time. The sum of these extra time distances over successive scans is at
// most `kMaxDetour_s`. Of the other scans of a laser, the nearest joins the frame, and the rest are dropped,
// such as the surplus scans of a laser that is faster than the first.
//
// A scan opens a frame itself if no scan of a laser with a smaller number is within `kMaxApart_s`. If the
// first laser stops, the other lasers continue without it. Lasers that rarely scan together open frames in
// turn.
#pragma once

#include <cmath>
#include <cstddef>
#include <deque>
#include <exception>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "psi_slam/frame_source.h"

namespace psi_slam {

class ScanSynchronizer {
 public:
  static constexpr double kMaxApart_s = 0.15;
  /// Largest sum of extra time distances, seconds, for successive scans of a laser that are passed on to the
  /// next frame. The extra distance is how much farther in time the next frame is than the nearest frame.
  static constexpr double kMaxDetour_s = 0.15;
  static constexpr double kMaxMotion_m = 1.0;
  static constexpr double kMaxTurn_rad = M_PI / 3;
  /// A time stamp that is earlier than the latest one by more than this, seconds, shows that the clock was
  /// set. Scans before and after the change of the clock never share a frame.
  static constexpr double kClockWasSet_s = 1.0;
  /// Largest number of scans that wait for later scans. If more scans arrive, time stamps no longer delay
  /// frames.
  static constexpr std::size_t kMaxWaiting = 300;

  /// Adds one scan with odometry of its own time, in the order of the log. `scan.laser` must be set.
  void add(Frame frame);
  void end_of_log() { ended_ = true; }

  /// Returns the next frame if all its scans have arrived. Frames have the order of the scans that open them.
  std::optional<Frame> take();

  /// Number of scans that were dropped because they joined no frame.
  std::size_t spare_scans() const { return spare_scans_; }

 private:
  struct Scan {
    Frame frame;
    std::size_t place = 0;  // position in the log
    std::size_t clock = 0;  // number of clock changes before the scan
  };

  static bool may_join(const Scan& scan, const Scan& opener);
  bool must_wait(const Scan& scan) const;
  bool opens(const Scan& scan) const;
  const Scan* frame_of(const Scan& scan, const Scan* excluded = nullptr) const;
  const Scan& choose(const std::vector<const Scan*>& claimants, const Scan& opener,
                     std::vector<std::size_t>& used);

  std::deque<Scan> scans_;
  TimeUs latest_us_ = 0;
  std::size_t places_ = 0;
  std::size_t clock_ = 0;
  std::size_t spare_scans_ = 0;
  // Sum of the extra time distances of each laser since its last frame that passed on no scan.
  std::map<std::size_t, TimeUs> detours_us_;
  bool ended_ = false;
};

/// Combines the frames of another source, each a scan of one laser, into frames of all lasers. Throws an
/// error of the source after the last frame before the error.
class SynchronizedSource : public FrameSource {
 public:
  explicit SynchronizedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  /// Returns the next combined frame. Its index counts combined frames.
  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override;
  std::vector<std::string> assumptions() const override { return source_->assumptions(); }

 private:
  std::unique_ptr<FrameSource> source_;
  ScanSynchronizer synchronizer_;
  std::size_t frames_given_ = 0;
  bool at_end_ = false;
  std::exception_ptr failure_;
};

}  // namespace psi_slam
