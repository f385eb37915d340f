// SPDX-License-Identifier: BSD-3-Clause
#include "match/candidates.h"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "matching/make_matcher.h"

namespace psi_slam {
namespace {

/// The memetic search without one of its steps.
struct Ablation {
  const char* name;
  void (*apply)(MemeticGeneticOptions&);
};

constexpr Ablation kAblations[] = {
    {"ga without sparse search", [](MemeticGeneticOptions& options) { options.seed_coarse = false; }},
    {"ga without generations", [](MemeticGeneticOptions& options) { options.generations = 0; }},
    {"ga without crossover", [](MemeticGeneticOptions& options) { options.crossover_rate = 0; }},
    {"ga without elite", [](MemeticGeneticOptions& options) { options.elite = 0; }},
    {"ga without Gray code", [](MemeticGeneticOptions& options) { options.gray_code = false; }},
    {"ga without niches", [](MemeticGeneticOptions& options) { options.niches = false; }},
    {"ga without memory", [](MemeticGeneticOptions& options) { options.remember = false; }},
    {"ga without pooled fitness", [](MemeticGeneticOptions& options) { options.pooled_fitness = false; }},
    {"ga without descents", [](MemeticGeneticOptions& options) { options.descents = 0; }},
    {"ga without polish", [](MemeticGeneticOptions& options) { options.polished = 0; }},
    {"ga without early stop", [](MemeticGeneticOptions& options) { options.patience = 0; }},
};

}  // namespace

const Matcher& MatchCandidate::matcher(const LoopCase& loop_case) const {
  if (matchers_.size() == 1) return *matchers_.front();
  const auto named = std::find_if(matchers_.begin(), matchers_.end(), [&](const auto& matcher) {
    return matcher->name() == loop_case.adaptive_matcher;
  });
  if (named == matchers_.end())
    throw std::logic_error("no matcher is called \"" + loop_case.adaptive_matcher + '"');
  return **named;
}

std::vector<MatchCandidate> match_candidates(CandidateSet set, const MapperOptions& options) {
  GeneticOptions genetic = options.back_end.genetic;
  genetic.variant = GeneticVariant::kMemetic;
  const auto make = [&options](MatcherKind kind, const GeneticOptions& how) {
    return std::shared_ptr<const Matcher>(make_matcher(kind, options.back_end.loop_matcher, how));
  };
  GeneticOptions paper = genetic;
  paper.variant = GeneticVariant::kPaper;
  const auto csm = make(MatcherKind::kCsm, genetic);
  const auto csm_ga = make(MatcherKind::kCsmGa, genetic);
  const auto ga = make(MatcherKind::kGa, genetic);
  std::vector<MatchCandidate> all{
      {"csm", csm}, {"csm_ga", csm_ga}, {"ga", ga}, {"ga_paper", make(MatcherKind::kGa, paper)}};
  if (set == CandidateSet::kMatchers) return all;
  const std::vector<std::shared_ptr<const Matcher>> choices{csm, csm_ga, ga};
  all.insert(all.end() - 1, MatchCandidate("adaptive", choices));
  for (const Ablation& ablation : kAblations) {
    GeneticOptions without = genetic;
    ablation.apply(without.memetic);
    all.emplace_back(ablation.name, make(MatcherKind::kGa, without));
  }
  all.emplace_back("csm_ga_paper", make(MatcherKind::kCsmGa, paper));
  GeneticOptions few_cells = genetic;
  few_cells.coarse.cells = 256;
  all.emplace_back("csm_ga with 256 cells", make(MatcherKind::kCsmGa, few_cells));
  GeneticOptions no_generations = genetic;
  no_generations.memetic.generations = 0;
  all.emplace_back("csm_ga without generations", make(MatcherKind::kCsmGa, no_generations));
  return all;
}

}  // namespace psi_slam
