// SPDX-License-Identifier: BSD-3-Clause
// Equation 1 by branch and bound (Olson 2009; Hess et al. 2016) on the score grid's pyramid: the same pose as
// exhaustive_search(), ties included, at a small share of its work. Unlike those papers' depth-first trees,
// the coarsest level is summed for the whole window at once (runs of neighbouring cells, all in the cache),
// its blocks are visited from the most promising down, and each is expanded sixteenfold.
#pragma once

#include "matching/exhaustive_search.h"

namespace psi_slam {

/// The best of all poses whose sum is at least `min_sum`, in Candidate's order.
/// Throws std::invalid_argument when the lattice's grid has no pyramid.
SearchOutcome branch_and_bound_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                      const std::optional<ExcludedRegion>& excluded = {});

}  // namespace psi_slam
