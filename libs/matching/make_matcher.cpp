// SPDX-License-Identifier: BSD-3-Clause
#include "matching/make_matcher.h"

#include <stdexcept>

#include "matching/coarse_to_genetic_matcher.h"
#include "matching/correlative_matcher.h"
#include "matching/genetic_matcher.h"

namespace psi_slam {

std::unique_ptr<Matcher> make_matcher(MatcherKind kind, const MatcherOptions& options,
                                      const GeneticOptions& genetic) {
  switch (kind) {
    case MatcherKind::kCsm:
      return std::make_unique<CorrelativeMatcher>(options);
    case MatcherKind::kCsmGa:
      return std::make_unique<CoarseToGeneticMatcher>(options, genetic);
    case MatcherKind::kGa:
      return std::make_unique<GeneticMatcher>(options, genetic);
  }
  throw std::invalid_argument("no such kind of matcher");
}

}  // namespace psi_slam
