// SPDX-License-Identifier: BSD-3-Clause
// The genetic algorithm of the paper, exactly (section 3.1): binary chromosomes of equations 9, 10 and 12,
// the response of equation 11 as fitness, roulette wheel, two-point crossover, bit-flip mutation, each
// generation replacing the last. Its answer is the best pose of all generations.
#pragma once

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"

namespace psi_slam {

FoundPeaks paper_genetic_search(const SearchLattice& lattice, const PeakRequest& request,
                                const PaperGeneticOptions& options);

}  // namespace psi_slam
