// SPDX-License-Identifier: BSD-3-Clause
// Combines the scans of a robot's lasers into frames (scan synchronisation).
//
// Each scan of the first laser opens a frame. One scan of every other laser may join it if it is at most
// `kMaxApart_s` away in time. Odometry at both times gives the robot's motion in between. If the motion
// exceeds `kMaxMotion_m` or `kMaxTurn_rad`, odometry has jumped, and the scan is dropped.
//
// A scan belongs to the frame nearest in time. If that frame has several scans of one laser, which is usual
// if lasers scan half a period apart, the nearest scan joins it. Scans about half-way to the next frame are
// passed on to that frame, until these detours sum to `kMaxDetour_s`. The other scans are dropped, such as
// the surplus scans of a laser that is faster than the first.
//
// A scan without any scan of an earlier laser within `kMaxApart_s` opens a frame itself. If the first laser
// falls silent, the others continue without it. Lasers that hardly ever scan together take turns.
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
  /// Largest sum of the extra time distances by which consecutive scans of a laser join a later frame.
  static constexpr double kMaxDetour_s = 0.15;
  static constexpr double kMaxMotion_m = 1.0;
  static constexpr double kMaxTurn_rad = M_PI / 3;
  /// A stamp that is earlier than the latest by more than this shows that the clock was set. Scans before and
  /// after that moment never share a frame.
  static constexpr double kClockWasSet_s = 1.0;
  /// At most this number of scans wait for later ones. If more arrive, their time stamps are meaningless.
  static constexpr std::size_t kMaxWaiting = 300;

  /// Adds one scan with odometry of its own time, in the order of the log. `scan.laser` must be set.
  void add(Frame frame);
  void end_of_log() { ended_ = true; }

  /// Returns the next frame if all its scans have arrived. Frames have the order of the scans that open them.
  std::optional<Frame> take();

  /// Number of scans of later lasers that joined no frame.
  std::size_t spare_scans() const { return spare_scans_; }

 private:
  struct Scan {
    Frame frame;
    std::size_t place = 0;  // in the log
    std::size_t clock = 0;  // how often the clock was set before
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
  std::map<std::size_t, TimeUs>
      detours_us_;  // by laser, since one of its scans last joined the nearest frame
  bool ended_ = false;
};

/// Combines the frames of another source, each a scan of one laser, into frames of all lasers. An error of
/// the source is thrown after the last frame before it.
class SynchronizedSource : public FrameSource {
 public:
  explicit SynchronizedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

  /// The index of each frame counts the combined frames.
  std::optional<Frame> next() override;
  double progress() const override { return source_->progress(); }
  SkippedLines skipped_lines() const override;

 private:
  std::unique_ptr<FrameSource> source_;
  ScanSynchronizer synchronizer_;
  std::size_t frames_given_ = 0;
  bool at_end_ = false;
  std::exception_ptr failure_;
};

}  // namespace psi_slam
