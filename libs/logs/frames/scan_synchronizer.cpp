// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/scan_synchronizer.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr auto kMaxApart_us = static_cast<TimeUs>(ScanSynchronizer::kMaxApart_s * 1e6);
constexpr auto kMaxDetour_us = static_cast<TimeUs>(ScanSynchronizer::kMaxDetour_s * 1e6);
/// The next frame of a scan that is passed on is at most this many times as far in time as the nearest frame.
constexpr TimeUs kFarther = 2;
constexpr auto kClockWasSet_us = static_cast<TimeUs>(ScanSynchronizer::kClockWasSet_s * 1e6);
/// A scan waits for scans that are this much later. Scans of a frame are at most kMaxApart_us from its
/// opener. Other frames that these scans may join are at most 2 * kMaxApart_us from the opener. The third
/// kMaxApart_us allows for different delays of the lasers' messages.
constexpr TimeUs kWait_us = 3 * kMaxApart_us;

/// Distance between two scans, for comparison: first in time, then by position in the log.
template <class Scan>
std::pair<TimeUs, std::size_t> distance(const Scan& a, const Scan& b) {
  return {std::abs(a.frame.time_us - b.frame.time_us),
          a.place < b.place ? b.place - a.place : a.place - b.place};
}

/// Returns whether a robot can have moved so far between two scans of a frame. Otherwise odometry jumped.
bool is_plausible(const mrpt::math::TPose2D& motion) {
  return portable::hypot(motion.x, motion.y) <= ScanSynchronizer::kMaxMotion_m &&
         std::abs(motion.phi) <= ScanSynchronizer::kMaxTurn_rad;
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
         std::abs(opener.frame.time_us - scan.frame.time_us) <= kMaxApart_us;
}

bool ScanSynchronizer::must_wait(const Scan& scan) const {
  return !ended_ && scan.clock == clock_ && latest_us_ < scan.frame.time_us + kWait_us &&
         scans_.size() <= kMaxWaiting;
}

bool ScanSynchronizer::opens(const Scan& scan) const {
  if (scan.frame.scan.laser == 0) return true;
  return std::none_of(scans_.begin(), scans_.end(),
                      [&](const Scan& other) { return may_join(scan, other) && opens(other); });
}

/// Returns the scan that opens the nearest frame which `scan` may join, except the frame that `excluded`
/// opens. Returns null if there is no such frame.
const ScanSynchronizer::Scan* ScanSynchronizer::frame_of(const Scan& scan, const Scan* excluded) const {
  const Scan* nearest = nullptr;
  for (const Scan& other : scans_) {
    if (&other == excluded || !may_join(scan, other) ||
        (nearest != nullptr && !(distance(scan, other) < distance(scan, *nearest))))
      continue;
    if (opens(other)) nearest = &other;
  }
  return nearest;
}

/// Chooses which of `claimants` joins the frame of `opener`. Claimants are scans of one laser whose nearest
/// frame this is. Adds the places of all claimants to `used`, except those passed on to the next frame.
const ScanSynchronizer::Scan& ScanSynchronizer::choose(const std::vector<const Scan*>& claimants,
                                                       const Scan& opener, std::vector<std::size_t>& used) {
  const auto nearest_of = [&](const std::vector<const Scan*>& scans) {
    return *std::min_element(scans.begin(), scans.end(), [&](const Scan* a, const Scan* b) {
      return distance(*a, opener) < distance(*b, opener);
    });
  };
  std::map<const Scan*, TimeUs> passed_on;  // scans passed on, with their extra time distances
  TimeUs& detours_us = detours_us_[claimants.front()->frame.scan.laser];
  std::vector<const Scan*> others;
  for (const Scan* scan : claimants) {
    const Scan* next = claimants.size() > 1 ? frame_of(*scan, &opener) : nullptr;
    const TimeUs here_us = distance(*scan, opener).first;
    const TimeUs there_us = next == nullptr ? 0 : distance(*scan, *next).first;
    if (next != nullptr && there_us <= kFarther * here_us && detours_us + there_us - here_us <= kMaxDetour_us)
      passed_on[scan] = there_us - here_us;
    else
      others.push_back(scan);
  }
  const Scan* own = nearest_of(others.empty() ? claimants : others);
  passed_on.erase(own);
  if (passed_on.empty()) detours_us = 0;
  for (const Scan* scan : claimants) {
    if (const auto passed = passed_on.find(scan); passed != passed_on.end())
      detours_us += passed->second;
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
  std::map<std::size_t, std::vector<const Scan*>> claimants;  // claimants by laser
  for (const Scan& scan : scans_)
    if (may_join(scan, *opener) && frame_of(scan) == &*opener)
      claimants[scan.frame.scan.laser].push_back(&scan);
  Frame frame = opener->frame;
  std::vector<std::size_t> used{opener->place};
  for (const auto& [laser, scans] : claimants) {
    const Frame& chosen = choose(scans, *opener, used).frame;
    CompanionScan companion{chosen.scan, chosen.time_us, {}};
    if (frame.has_odometry && chosen.has_odometry)
      companion.frame_T_robot = between(frame.odom_T_robot, chosen.odom_T_robot);
    else if (frame.imu_heading_rad && chosen.imu_heading_rad)
      companion.frame_T_robot.phi = mrpt::math::wrapToPi(*chosen.imu_heading_rad - *frame.imu_heading_rad);
    if (is_plausible(companion.frame_T_robot)) frame.companions.push_back(std::move(companion));
  }
  spare_scans_ += used.size() - 1 - frame.companions.size();
  const auto is_used = [&](const Scan& scan) {
    return std::find(used.begin(), used.end(), scan.place) != used.end();
  };
  scans_.erase(std::remove_if(scans_.begin(), scans_.end(), is_used), scans_.end());
  return frame;
}

std::optional<Frame> SynchronizedSource::next() {
  while (true) {
    if (auto frame = synchronizer_.take()) {
      frame->index = frames_given_++;
      return frame;
    }
    if (at_end_) {
      if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
      return std::nullopt;
    }
    try {
      if (auto scan = source_->next()) {
        synchronizer_.add(*std::move(scan));
        continue;
      }
    } catch (const UserError&) {
      failure_ = std::current_exception();
    }
    at_end_ = true;
    synchronizer_.end_of_log();
  }
}

SkippedLines SynchronizedSource::skipped_lines() const {
  SkippedLines skipped = source_->skipped_lines();
  skipped.spare_scans += synchronizer_.spare_scans();
  return skipped;
}

}  // namespace psi_slam
