// SPDX-License-Identifier: BSD-3-Clause
// The matchers by the names that the `.ini` and the records give them.
#pragma once

#include <memory>

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"
#include "psi_slam/matching.h"

namespace psi_slam {

std::unique_ptr<Matcher> make_matcher(MatcherKind kind, const MatcherOptions& options,
                                      const GeneticOptions& genetic);

}  // namespace psi_slam
