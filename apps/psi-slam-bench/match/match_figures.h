// SPDX-License-Identifier: BSD-3-Clause
// Judges the match of a case, and sums up the figures of a matcher over all cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base/degrees.h"
#include "match/loop_cases.h"
#include "matching/matcher.h"

namespace psi_slam {

/// Largest distance of a successful match from the truth.
inline constexpr double kSuccess_m = 0.3;
inline constexpr double kSuccess_rad = radians_from_degrees(3.5L);

struct Judgement {
  bool success = false;       ///< positive cases: found within the limits above
  bool same_optimum = false;  ///< positive cases: at least as good as exact CSM's match, or none by either
  bool false_accept = false;  ///< negative cases: found with a response that loop closing would accept
};

/// `exact` is the match of exact CSM in the same case.
Judgement judge(const LoopCase& loop_case, const MatchResult& match, const MatchResult& exact,
                double accepted_response);

struct TimeFigures {
  double mean = 0;
  double p50 = 0;
  double p95 = 0;
  double p99 = 0;
};

struct MatchFigures {
  std::size_t cases = 0;
  std::size_t positive = 0;
  std::size_t negative = 0;
  std::optional<double> success_rate;       ///< of the positive cases; empty without positive cases
  std::optional<double> same_optimum_rate;  ///< of the positive cases; empty without positive cases
  std::optional<double> false_accept_rate;  ///< of the negative cases; empty without negative cases
  double evaluations = 0;                   ///< mean
  TimeFigures time_ms;
  /// Share of the decoded codes that lay outside the window.
  std::optional<double> repaired_share;
};

class MatchTally {
 public:
  void add(const LoopCase& loop_case, const Judgement& judgement, const MatchResult& match, double time_ms);

  /// The percentile p of n values is the value of rank floor(p n / 100), counted from 0.
  MatchFigures figures() const;

 private:
  std::size_t positive_ = 0;
  std::size_t negative_ = 0;
  std::size_t successes_ = 0;
  std::size_t same_optima_ = 0;
  std::size_t false_accepts_ = 0;
  std::int64_t evaluations_ = 0;
  GeneticEffort genetic_;
  std::vector<double> times_ms_;
};

}  // namespace psi_slam
