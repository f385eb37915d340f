// SPDX-License-Identifier: BSD-3-Clause
// The searches that matchers ran, as a cell of a table.
#pragma once

#include <array>
#include <cstddef>

#include "batch/report_table.h"
#include "psi_slam/matching.h"

namespace psi_slam {

/// Cell with the shares of the searches, the most frequent first: "genetic", "coarse_genetic 98.0 %, coarse
/// 2.0 %". As data, the number of each kind. `searches` has the numbers in the order of kSearchKinds.
ReportCell searches_cell(const std::array<std::size_t, kSearchKinds.size()>& searches);

}  // namespace psi_slam
