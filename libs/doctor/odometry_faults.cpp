// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/odometry_faults.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "doctor/pair_alignment.h"
#include "doctor/scan_alignment.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

constexpr double kJumpSpeed_m_s = 3.0;
constexpr double kJump_m = 0.4;
const double kJumpSpeed_rad_s = DEG2RAD(150.0);
const double kJump_rad = DEG2RAD(30.0);

}  // namespace

std::vector<FramePair> suspected_jumps(const std::vector<FrameMark>& marks, double median_period_s,
                                       std::size_t most) {
  std::vector<std::pair<double, FramePair>> suspects;
  for (std::size_t i = 1; i < marks.size(); ++i) {
    const TPose2D step = odometry_between(marks, {i - 1, i});
    const double period_s = std::max(seconds(marks[i].time_us - marks[i - 1].time_us), median_period_s);
    const bool too_far = step.norm() > std::max(kJump_m, kJumpSpeed_m_s * period_s);
    const bool too_fast = std::abs(step.phi) > std::max(kJump_rad, kJumpSpeed_rad_s * period_s);
    if (too_far || too_fast) suspects.push_back({step.norm() + std::abs(step.phi), {i - 1, i}});
  }
  std::stable_sort(suspects.begin(), suspects.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<FramePair> pairs;
  for (std::size_t i = 0; i < std::min(most, suspects.size()); ++i) pairs.push_back(suspects[i].second);
  return pairs;
}

OdometryJumps confirm_jumps(const std::vector<FrameMark>& marks, const std::vector<FramePair>& suspects,
                            const ScanLibrary& library) {
  OdometryJumps jumps;
  for (const FramePair& pair : suspects) {
    const TPose2D step = odometry_between(marks, pair);
    std::vector<TPose2D> guesses{step};
    for (const double turn_deg : {-24.0, -12.0, 0.0, 12.0, 24.0})
      guesses.push_back({0, 0, DEG2RAD(turn_deg)});
    const ScanAlignment alignment =
        align_scans(AlignableScan(library.at(pair.first)), AlignableScan(library.at(pair.second)), guesses);
    const TPose2D& motion = alignment.reference_T_scan;
    const bool stayed = is_reliable(alignment) && motion.norm() < 0.5 * step.norm() + 0.05 &&
                        std::abs(motion.phi) < 0.5 * std::abs(step.phi) + DEG2RAD(5.0);
    if (!stayed) continue;
    jumps.pairs.push_back(pair);
    jumps.largest_m = std::max(jumps.largest_m, step.norm());
    jumps.largest_turn_rad = std::max(jumps.largest_turn_rad, std::abs(step.phi));
  }
  return jumps;
}

RevisitAgreement check_revisits(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                const ScanLibrary& library) {
  constexpr double kSame_m = 0.05;
  const double same_rad = DEG2RAD(1.0);
  RevisitAgreement agreement;
  agreement.revisits = pairs.size();
  std::vector<double> offsets_m;
  for (const AlignedPair& pair : align_pairs(marks, pairs, library)) {
    const TPose2D off = pair.by_scans.reference_T_scan - pair.by_odometry;
    if (!is_reliable(pair.by_scans) || off.norm() > kSame_m || std::abs(off.phi) > same_rad) continue;
    offsets_m.push_back(off.norm());
  }
  agreement.agreeing = offsets_m.size();
  if (offsets_m.empty()) return agreement;
  const auto middle = offsets_m.begin() + static_cast<std::ptrdiff_t>(offsets_m.size() / 2);
  std::nth_element(offsets_m.begin(), middle, offsets_m.end());
  agreement.median_offset_m = *middle;
  return agreement;
}

}  // namespace psi_slam
