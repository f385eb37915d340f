// SPDX-License-Identifier: BSD-3-Clause
// Residuals of the accepted loops at the finished map: a loop that the map contradicts is a suspect.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Residual of one accepted loop: its measured pose against the poses of the map.
struct LoopResidual {
  std::size_t loop = 0;     ///< index in MappingResult::loops
  double residual_m = 0;    ///< distance between measured and mapped position of the node
  double residual_rad = 0;  ///< difference of the headings
  /// Residual in standard deviations. The variances are those of the match, and of 0.05 m and 0.01 rad for
  /// errors within a local map.
  double chi = 0;
};

/// Returns the residuals of all accepted loops, the largest chi first.
std::vector<LoopResidual> loop_residuals(const MappingResult& result);

}  // namespace psi_slam
