// SPDX-License-Identifier: BSD-3-Clause
#include "match/match_figures.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace psi_slam {
namespace {

std::optional<double> share(std::size_t part, std::size_t all) {
  if (all == 0) return std::nullopt;
  return static_cast<double>(part) / static_cast<double>(all);
}

}  // namespace

Judgement judge(const LoopCase& loop_case, const MatchResult& match, const MatchResult& exact,
                double accepted_response) {
  Judgement judgement;
  if (loop_case.positive) {
    const mrpt::math::TPose2D off = match.map_T_robot - loop_case.anchor_T_node;
    judgement.success =
        match.found && std::hypot(off.x, off.y) <= kSuccess_m && std::abs(off.phi) <= kSuccess_rad;
    judgement.same_optimum = match.found == exact.found && (!match.found || match.response >= exact.response);
  } else {
    judgement.false_accept = match.found && match.response >= accepted_response;
  }
  return judgement;
}

void MatchTally::add(const LoopCase& loop_case, const Judgement& judgement, const MatchResult& match,
                     double time_ms) {
  ++(loop_case.positive ? positive_ : negative_);
  successes_ += judgement.success ? 1 : 0;
  same_optima_ += judgement.same_optimum ? 1 : 0;
  false_accepts_ += judgement.false_accept ? 1 : 0;
  evaluations_ += match.evaluations;
  genetic_.decoded += match.genetic.decoded;
  genetic_.repaired += match.genetic.repaired;
  times_ms_.push_back(time_ms);
}

MatchFigures MatchTally::figures() const {
  MatchFigures figures;
  figures.cases = times_ms_.size();
  figures.positive = positive_;
  figures.negative = negative_;
  figures.success_rate = share(successes_, positive_);
  figures.same_optimum_rate = share(same_optima_, positive_);
  figures.false_accept_rate = share(false_accepts_, negative_);
  if (genetic_.decoded > 0)
    figures.repaired_share = static_cast<double>(genetic_.repaired) / static_cast<double>(genetic_.decoded);
  if (times_ms_.empty()) return figures;
  const auto count = static_cast<double>(times_ms_.size());
  figures.evaluations = static_cast<double>(evaluations_) / count;
  std::vector<double> sorted = times_ms_;
  std::sort(sorted.begin(), sorted.end());
  const auto percentile = [&sorted](std::size_t percent) { return sorted[sorted.size() * percent / 100]; };
  figures.time_ms = {std::accumulate(sorted.begin(), sorted.end(), 0.0) / count, percentile(50),
                     percentile(95), percentile(99)};
  return figures;
}

}  // namespace psi_slam
