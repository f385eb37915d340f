// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/scan_uniter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

namespace psi_slam {
namespace {

constexpr auto kMostApart_us = static_cast<TimeUs>(ScanUniter::kMostApart_s * 1e6);
constexpr auto kClockWasSet_us = static_cast<TimeUs>(ScanUniter::kClockWasSet_s * 1e6);
/// A frame's scans lie within one such time of it, the frames that these might join instead within two; and
/// messages of different lasers come late by different times.
constexpr TimeUs kWait_us = 3 * kMostApart_us;
constexpr double kMostMoved_m = 1.0;
constexpr double kMostTurned_rad = M_PI / 3;

/// In time, and where that is the same, in the log.
template <class Scan>
std::pair<TimeUs, std::size_t> distance(const Scan& a, const Scan& b) {
  return {std::abs(a.frame.time_us - b.frame.time_us),
          a.place < b.place ? b.place - a.place : a.place - b.place};
}

/// Whether a robot can have moved so between two scans of a frame; else its odometry jumped.
bool is_drive(const mrpt::math::TPose2D& motion) {
  return std::hypot(motion.x, motion.y) <= kMostMoved_m && std::abs(motion.phi) <= kMostTurned_rad;
}

}  // namespace

void ScanUniter::add(Frame frame) {
  const bool first = places_ == 0;
  const bool clock_was_set = !first && frame.time_us < latest_us_ - kClockWasSet_us;
  if (clock_was_set) ++clock_;
  latest_us_ = first || clock_was_set ? frame.time_us : std::max(latest_us_, frame.time_us);
  scans_.push_back({std::move(frame), places_++, clock_});
}

bool ScanUniter::may_join(const Scan& scan, const Scan& opener) {
  return opener.clock == scan.clock && opener.frame.scan.laser < scan.frame.scan.laser &&
         std::abs(opener.frame.time_us - scan.frame.time_us) <= kMostApart_us;
}

bool ScanUniter::must_wait(const Scan& scan) const {
  return !ended_ && scan.clock == clock_ && latest_us_ < scan.frame.time_us + kWait_us &&
         scans_.size() <= kMostWaiting;
}

bool ScanUniter::opens(const Scan& scan) const {
  if (scan.frame.scan.laser == 0) return true;
  return std::none_of(scans_.begin(), scans_.end(),
                      [&](const Scan& other) { return may_join(scan, other) && opens(other); });
}

/// The scan that opens the frame which `scan` belongs to, joins or is too many for; none when it opens one.
const ScanUniter::Scan* ScanUniter::frame_of(const Scan& scan) const {
  const Scan* nearest = nullptr;
  for (const Scan& other : scans_) {
    if (!may_join(scan, other) || (nearest != nullptr && !(distance(scan, other) < distance(scan, *nearest))))
      continue;
    if (opens(other)) nearest = &other;
  }
  return nearest;
}

std::optional<Frame> ScanUniter::take() {
  if (scans_.empty() || must_wait(scans_.front())) return std::nullopt;
  const auto opener =
      std::find_if(scans_.begin(), scans_.end(), [this](const Scan& scan) { return opens(scan); });
  if (must_wait(*opener)) return std::nullopt;
  std::vector<std::size_t> used{opener->place};
  std::map<std::size_t, const Scan*> companions;  // by laser
  for (const Scan& scan : scans_) {
    if (!may_join(scan, *opener) || frame_of(scan) != &*opener) continue;
    used.push_back(scan.place);
    const Scan*& nearest = companions[scan.frame.scan.laser];
    if (nearest == nullptr || distance(scan, *opener) < distance(*nearest, *opener)) nearest = &scan;
  }
  Frame frame = opener->frame;
  for (const auto& [laser, scan] : companions) {
    CompanionScan companion{scan->frame.scan, scan->frame.time_us, {}};
    if (frame.has_odometry && scan->frame.has_odometry)
      companion.frame_T_robot = scan->frame.odom_T_robot - frame.odom_T_robot;
    if (!is_drive(companion.frame_T_robot)) {
      ++left_out_;
      continue;
    }
    frame.companions.push_back(std::move(companion));
  }
  left_out_ += used.size() - 1 - companions.size();
  const auto is_used = [&](const Scan& scan) {
    return std::find(used.begin(), used.end(), scan.place) != used.end();
  };
  scans_.erase(std::remove_if(scans_.begin(), scans_.end(), is_used), scans_.end());
  return frame;
}

}  // namespace psi_slam
