// SPDX-License-Identifier: BSD-3-Clause
// A genetic algorithm with local search. What a plain one lacks on a rugged response (method, section 5),
// each idea a switch of MemeticGeneticOptions: tiles instead of poses, Gray code, a first generation from a
// sparse coarse search, fitness on the max-pooled grid first, elitism, niches, local descent, and an end when
// the best stands still.
#pragma once

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"

namespace psi_slam {

FoundPeaks memetic_search(const SearchLattice& lattice, const PeakRequest& request,
                          const MemeticGeneticOptions& options);

}  // namespace psi_slam
