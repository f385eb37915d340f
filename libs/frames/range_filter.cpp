// SPDX-License-Identifier: BSD-3-Clause
#include "frames/range_filter.h"

#include <limits>

namespace psi_slam {

void mark_no_returns(std::vector<float>& ranges_m, double min_range_m, double max_range_m) {
  // In single precision on both sides, so that a reading written as "50.00" is at a maximum of 50.00.
  const auto min_range = static_cast<float>(min_range_m);
  const auto max_range = static_cast<float>(max_range_m);
  for (float& range : ranges_m) {
    const bool is_return = range > 0 && range >= min_range && range < max_range;
    if (!is_return) range = std::numeric_limits<float>::quiet_NaN();
  }
}

}  // namespace psi_slam
