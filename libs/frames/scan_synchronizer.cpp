// SPDX-License-Identifier: BSD-3-Clause
#include "frames/scan_synchronizer.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

namespace psi_slam {
namespace {

constexpr auto kMostApart_us = static_cast<TimeUs>(ScanSynchronizer::kMostApart_s * 1e6);
constexpr auto kMostDetour_us = static_cast<TimeUs>(ScanSynchronizer::kMostDetour_s * 1e6);
/// A scan goes on to the next frame only where that is at most so many times as far as the nearest.
constexpr TimeUs kFarther = 2;
constexpr auto kClockWasSet_us = static_cast<TimeUs>(ScanSynchronizer::kClockWasSet_s * 1e6);
/// A frame's scans lie within one such time of it, the frames that these might join instead within two; and
/// messages of different lasers come late by different times.
constexpr TimeUs kWait_us = 3 * kMostApart_us;

/// In time, and where that is the same, in the log.
template <class Scan>
std::pair<TimeUs, std::size_t> distance(const Scan& a, const Scan& b) {
  return {std::abs(a.frame.time_us - b.frame.time_us),
          a.place < b.place ? b.place - a.place : a.place - b.place};
}

/// Whether a robot can have moved so between two scans of a frame; else its odometry jumped.
bool is_drive(const mrpt::math::TPose2D& motion) {
  return std::hypot(motion.x, motion.y) <= ScanSynchronizer::kMostMoved_m &&
         std::abs(motion.phi) <= ScanSynchronizer::kMostTurned_rad;
}

}  // namespace

void ScanSynchronizer::add(Frame frame) {
  const bool first = places_ == 0;
  const bool clock_was_set = !first && frame.time_us < latest_us_ - kClockWasSet_us;
  if (clock_was_set) ++clock_;
  latest_us_ = first || clock_was_set ? frame.time_us : std::max(latest_us_, frame.time_us);
  scans_.push_back({std::move(frame), places_++, clock_});
}

bool ScanSynchronizer::may_join(const Scan& scan, const Scan& opener) {
  return opener.clock == scan.clock && opener.frame.scan.laser < scan.frame.scan.laser &&
         std::abs(opener.frame.time_us - scan.frame.time_us) <= kMostApart_us;
}

bool ScanSynchronizer::must_wait(const Scan& scan) const {
  return !ended_ && scan.clock == clock_ && latest_us_ < scan.frame.time_us + kWait_us &&
         scans_.size() <= kMostWaiting;
}

bool ScanSynchronizer::opens(const Scan& scan) const {
  if (scan.frame.scan.laser == 0) return true;
  return std::none_of(scans_.begin(), scans_.end(),
                      [&](const Scan& other) { return may_join(scan, other) && opens(other); });
}

/// The scan that opens the nearest frame which `scan` may join, left aside that of `but`; none when it opens
/// one.
const ScanSynchronizer::Scan* ScanSynchronizer::frame_of(const Scan& scan, const Scan* but) const {
  const Scan* nearest = nullptr;
  for (const Scan& other : scans_) {
    if (&other == but || !may_join(scan, other) ||
        (nearest != nullptr && !(distance(scan, other) < distance(scan, *nearest))))
      continue;
    if (opens(other)) nearest = &other;
  }
  return nearest;
}

const ScanSynchronizer::Scan& ScanSynchronizer::choose(const std::vector<const Scan*>& claimants, const Scan& opener,
                                           std::vector<std::size_t>& used) {
  const auto nearest_of = [&](const std::vector<const Scan*>& scans) {
    return *std::min_element(scans.begin(), scans.end(), [&](const Scan* a, const Scan* b) {
      return distance(*a, opener) < distance(*b, opener);
    });
  };
  std::map<const Scan*, TimeUs> can_go_on;  // and by how much farther
  TimeUs& detours_us = detours_us_[claimants.front()->frame.scan.laser];
  std::vector<const Scan*> others;
  for (const Scan* scan : claimants) {
    const Scan* next = claimants.size() > 1 ? frame_of(*scan, &opener) : nullptr;
    const TimeUs here_us = distance(*scan, opener).first;
    const TimeUs there_us = next == nullptr ? 0 : distance(*scan, *next).first;
    if (next != nullptr && there_us <= kFarther * here_us &&
        detours_us + there_us - here_us <= kMostDetour_us)
      can_go_on[scan] = there_us - here_us;
    else
      others.push_back(scan);
  }
  const Scan* own = nearest_of(others.empty() ? claimants : others);
  can_go_on.erase(own);
  if (can_go_on.empty()) detours_us = 0;
  for (const Scan* scan : claimants) {
    if (const auto going = can_go_on.find(scan); going != can_go_on.end())
      detours_us += going->second;
    else
      used.push_back(scan->place);
  }
  return *own;
}

std::optional<Frame> ScanSynchronizer::take() {
  if (scans_.empty() || must_wait(scans_.front())) return std::nullopt;
  const auto opener =
      std::find_if(scans_.begin(), scans_.end(), [this](const Scan& scan) { return opens(scan); });
  if (must_wait(*opener)) return std::nullopt;
  std::map<std::size_t, std::vector<const Scan*>> claimants;  // by laser
  for (const Scan& scan : scans_)
    if (may_join(scan, *opener) && frame_of(scan) == &*opener)
      claimants[scan.frame.scan.laser].push_back(&scan);
  Frame frame = opener->frame;
  std::vector<std::size_t> used{opener->place};
  for (const auto& [laser, scans] : claimants) {
    const Frame& chosen = choose(scans, *opener, used).frame;
    CompanionScan companion{chosen.scan, chosen.time_us, {}};
    if (frame.has_odometry && chosen.has_odometry)
      companion.frame_T_robot = chosen.odom_T_robot - frame.odom_T_robot;
    if (is_drive(companion.frame_T_robot)) frame.companions.push_back(std::move(companion));
  }
  left_out_ += used.size() - 1 - frame.companions.size();
  const auto is_used = [&](const Scan& scan) {
    return std::find(used.begin(), used.end(), scan.place) != used.end();
  };
  scans_.erase(std::remove_if(scans_.begin(), scans_.end(), is_used), scans_.end());
  return frame;
}

}  // namespace psi_slam
