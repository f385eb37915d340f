// SPDX-License-Identifier: BSD-3-Clause
// The matchers that the benchmark compares: those of the settings, the one of the paper, and the genetic
// matcher with one of its steps switched off at a time.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "match/loop_cases.h"
#include "matching/matcher.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

/// A row of the tables.
class MatchCandidate {
 public:
  MatchCandidate(std::string name, std::shared_ptr<const Matcher> matcher)
      : name_(std::move(name)), matchers_{std::move(matcher)} {}
  /// A candidate that uses, for each case, the matcher that the case names.
  MatchCandidate(std::string name, std::vector<std::shared_ptr<const Matcher>> adaptive)
      : name_(std::move(name)), matchers_(std::move(adaptive)) {}

  const std::string& name() const { return name_; }
  const Matcher& matcher(const LoopCase& loop_case) const;

 private:
  std::string name_;
  std::vector<std::shared_ptr<const Matcher>> matchers_;
};

enum class CandidateSet {
  kAll,       ///< with all ablations
  kMatchers,  ///< csm, csm_ga, ga and ga_paper
};

/// The first candidate is exact CSM, with which the others are compared.
std::vector<MatchCandidate> match_candidates(CandidateSet set, const MapperOptions& options);

}  // namespace psi_slam
