// SPDX-License-Identifier: BSD-3-Clause
// Puts the scans of a robot's lasers together into frames.
//
// Each scan of the first laser opens a frame, and of every other laser one scan may join, if no more than
// `kMostApart_s` lie between them. Odometry of both stamps tells how the robot moved in between; beyond
// `kMostMoved_m` or `kMostTurned_rad` it has jumped, and the scan is left out. A scan belongs to the frame
// nearest in time. Where that has several of a laser, as happens all the time when lasers scan half a period
// apart, those about half-way to the next frame go on to it, until such detours add up to `kMostDetour_s`; of
// the others the nearest joins. Of a laser that is faster than the first, the scans in between are left out.
// A scan that has none of a laser before its own within that time opens a frame of its own: when the first
// laser falls silent the others go on without it, and lasers that hardly ever scan together take turns.
#pragma once

#include <cmath>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "psi_slam/frame.h"

namespace psi_slam {

class ScanSynchronizer {
 public:
  static constexpr double kMostApart_s = 0.15;
  /// That scans of a laser, one after the other, join farther away than the nearest frame, all together.
  static constexpr double kMostDetour_s = 0.15;
  static constexpr double kMostMoved_m = 1.0;
  static constexpr double kMostTurned_rad = M_PI / 3;
  /// A stamp that much earlier than the latest tells of a clock that was set: scans before and after it are
  /// strangers.
  static constexpr double kClockWasSet_s = 1.0;
  /// More scans than this do not wait for later ones: their stamps say nothing.
  static constexpr std::size_t kMostWaiting = 300;

  /// Takes one scan with the odometry of its own time, in the order of the log; `scan.laser` counts.
  void add(Frame frame);
  void end_of_log() { ended_ = true; }

  /// The next frame all of whose scans have come, by the order in the log of the scans that open frames.
  std::optional<Frame> take();

  /// Scans that are in no frame, of lasers behind the first.
  std::size_t left_out() const { return left_out_; }

 private:
  struct Scan {
    Frame frame;
    std::size_t place = 0;  // in the log
    std::size_t clock = 0;  // how often it was set before
  };
  using Scans = std::deque<Scan>;

  static bool may_join(const Scan& scan, const Scan& opener);
  bool must_wait(const Scan& scan) const;
  bool opens(const Scan& scan) const;
  const Scan* frame_of(const Scan& scan, const Scan* but = nullptr) const;
  /// Of one laser's scans whose nearest frame is the opener's, the one that joins it; those that do not go on
  /// to the next frame are added to `used`.
  const Scan& choose(const std::vector<const Scan*>& claimants, const Scan& opener,
                     std::vector<std::size_t>& used);

  Scans scans_;
  TimeUs latest_us_ = 0;
  std::size_t places_ = 0;
  std::size_t clock_ = 0;
  std::size_t left_out_ = 0;
  std::map<std::size_t, TimeUs>
      detours_us_;  // by laser, until one of its scans joins the nearest frame again
  bool ended_ = false;
};

}  // namespace psi_slam
