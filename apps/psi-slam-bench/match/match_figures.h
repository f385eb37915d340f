// SPDX-License-Identifier: BSD-3-Clause
// What a matcher made of a case, and the figures over all cases.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "match/loop_cases.h"
#include "base/degrees.h"
#include "matching/matcher.h"

namespace psi_slam {

/// A positive case is a success when the match is at most this far from the truth.
inline constexpr double kSuccess_m = 0.3;
inline constexpr double kSuccess_rad = radians_from_degrees(3.5L);

struct Judgement {
  bool success = false;       ///< positive cases: found within the limits above
  bool same_optimum = false;  ///< positive cases: what exact CSM found, or as good
  bool false_accept = false;  ///< negative cases: found, and loop closing would accept its response
};

/// `exact` is exact CSM's match of the same case.
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
  std::optional<double> success_rate;       ///< over the positive cases, none without any
  std::optional<double> same_optimum_rate;  ///< likewise
  std::optional<double> false_accept_rate;  ///< over the negative cases, none without any
  double evaluations = 0;                   ///< mean
  TimeFigures time_ms;
  std::optional<double>
      repaired_share;  ///< of the codes that became poses, those that lay outside the window
};

class MatchTally {
 public:
  void add(const LoopCase& loop_case, const Judgement& judgement, const MatchResult& match, double time_ms);

  /// A percentile p is the value at rank floor(p n / 100), from 0.
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
