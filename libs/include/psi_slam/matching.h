// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Matcher and search window of a match, as records describe them.
#pragma once

#include <array>

namespace psi_slam {

/// Algorithm that searches for a match.
enum class MatcherKind {
  kCsm,    ///< exhaustive: the best pose of the search window
  kCsmGa,  ///< coarse cells ranked exhaustively, the best of them searched by the genetic algorithm
  kGa,     ///< the whole search window searched by the genetic algorithm
};

/// All matchers.
inline constexpr std::array<MatcherKind, 3> kMatcherKinds{MatcherKind::kCsm, MatcherKind::kCsmGa,
                                                          MatcherKind::kGa};

/// Name of a matcher in `.ini` files, CSV, JSON and sessions: "csm", "csm_ga" or "ga".
constexpr const char* name(MatcherKind kind) {
  constexpr std::array<const char*, kMatcherKinds.size()> kNames{"csm", "csm_ga", "ga"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// Half-widths of the search window around a predicted pose.
struct SearchExtent {
  double x_m = 0;        ///< along x
  double y_m = 0;        ///< along y
  double theta_rad = 0;  ///< in heading
};

}  // namespace psi_slam
