// SPDX-License-Identifier: BSD-3-Clause
// The matchers by the names that the `.ini` and the records give them.
#pragma once

#include <memory>

#include "matching/genetic_options.h"
#include "matching/window_matcher.h"

namespace psi_slam {

enum class MatcherKind {
  kCsm,    ///< "csm": the exact best pose of the window
  kCsmGa,  ///< "csm_ga": coarse cells ranked exhaustively, the best of them searched genetically
  kGa,     ///< "ga": the whole window searched genetically
};

const char* name(MatcherKind kind);

std::unique_ptr<Matcher> make_matcher(MatcherKind kind, const MatcherOptions& options,
                                      const GeneticOptions& genetic);

}  // namespace psi_slam
