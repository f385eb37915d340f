// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <vector>

namespace psi_slam {

/// Replaces by NaN every range, metres, that is no return: not finite, zero or negative, below `min_range_m`,
/// at or beyond `max_range_m`.
void mark_no_returns(std::vector<float>& ranges_m, double min_range_m, double max_range_m);

}  // namespace psi_slam
