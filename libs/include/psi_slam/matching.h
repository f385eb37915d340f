// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Kinds of matchers, and half-widths of search windows.
#pragma once

#include <array>

namespace psi_slam {

/// Algorithm that searches for a match.
enum class MatcherKind {
  kCsm,    ///< correlative scan matching: always finds the best pose of the search window
  kCsmGa,  ///< ranks coarse cells exhaustively, then searches the best of them genetically
  kGa,     ///< searches the whole window by the genetic algorithm
};

/// All matchers.
inline constexpr std::array<MatcherKind, 3> kMatcherKinds{MatcherKind::kCsm, MatcherKind::kCsmGa,
                                                          MatcherKind::kGa};

/// Name of a matcher in `.ini` files, CSV, JSON and sessions: "csm", "csm_ga" or "ga".
constexpr const char* name(MatcherKind kind) {
  constexpr std::array<const char*, kMatcherKinds.size()> kNames{"csm", "csm_ga", "ga"};
  return kNames[static_cast<std::size_t>(kind)];
}

/// Half-widths of the search window around a predicted pose, along the axes of the local map or map that is
/// searched.
struct SearchExtent {
  double x_m = 0;        ///< half-width along x, metres
  double y_m = 0;        ///< half-width along y, metres
  double theta_rad = 0;  ///< half-width in heading, radians
};

}  // namespace psi_slam
