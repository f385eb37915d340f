// SPDX-License-Identifier: BSD-3-Clause
// Chooses the loops that pictures of a map show, for the report and the window.
#pragma once

#include <cstddef>
#include <vector>

#include "psi_slam/loop_record.h"

namespace psi_slam {

/// Largest number of loops of each kind that a picture shows. More lines would hide the map. The kinds are
/// the candidates, the accepted loops, the outlier loops and the other rejected loops.
inline constexpr std::size_t kMaxLoopsDrawn = 500;

/// Returns the indices of the loops to draw, in increasing order: of each kind, all loops, or kMaxLoopsDrawn
/// evenly sampled ones. Loops that a person edited are always returned, and do not count. Attempts that found
/// nothing are left out.
std::vector<std::size_t> drawn_loops(const std::vector<LoopRecord>& loops);

}  // namespace psi_slam
