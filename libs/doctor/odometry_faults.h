// SPDX-License-Identifier: BSD-3-Clause
// Two faults of odometry that single pairs of scans show: jumps, and being no odometry at all but some
// mapper's result.
#pragma once

#include <cstddef>
#include <vector>

#include "doctor/log_facts.h"
#include "doctor/scan_sampling.h"

namespace psi_slam {

/// Pairs of consecutive frames between which odometry moves faster than a robot: above 3 m/s and 0.4 m, or
/// above 150 degrees/s and 30 degrees; at most `most`, the largest first. The median period stands in for
/// stamps that run backwards.
std::vector<FramePair> suspected_jumps(const std::vector<FrameMark>& marks, double median_period_s,
                                       std::size_t most);

struct OdometryJumps {
  std::vector<FramePair> pairs;  ///< where the scans moved by less than half of what odometry says
  double largest_m = 0;
  double largest_turn_rad = 0;
};

OdometryJumps confirm_jumps(const std::vector<FrameMark>& marks, const std::vector<FramePair>& suspects,
                            const ScanLibrary& library);

/// How well odometry knows old places again.
struct RevisitAgreement {
  std::size_t revisits = 0;    ///< pairs that odometry puts in one place, far apart on the way
  std::size_t agreeing = 0;    ///< of these, where the scans say the same to 5 cm and 1 degree
  double median_offset_m = 0;  ///< of the agreeing ones
};

RevisitAgreement check_revisits(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                const ScanLibrary& library);

}  // namespace psi_slam
