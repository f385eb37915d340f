// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/discarded_ranges.h"

#include <algorithm>
#include <memory>

namespace psi_slam {
namespace {

void discard_ranges(LaserScan& scan) {
  static const auto no_bearings = std::make_shared<const std::vector<float>>();
  std::vector<float>().swap(scan.ranges_m);  // clear() would keep the memory
  scan.bearings_rad = no_bearings;
}

}  // namespace

void discard_ranges(Frame& frame) {
  discard_ranges(frame.scan);
  for (CompanionScan& companion : frame.companions) discard_ranges(companion.scan);
}

bool has_ranges(const Frame& frame) {
  return !frame.scan.ranges_m.empty() ||
         std::any_of(frame.companions.begin(), frame.companions.end(),
                     [](const CompanionScan& companion) { return !companion.scan.ranges_m.empty(); });
}

}  // namespace psi_slam
