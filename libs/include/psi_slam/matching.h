// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Kinds of matchers and searches, and half-widths of search windows.
#pragma once

#include <array>
#include <cstddef>

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

/// Search that a matcher ran in a window. A matcher chooses it by the size of the window, so different
/// matchers run the same search in small windows.
enum class SearchKind {
  kExhaustive,      ///< scored every pose of the window
  kBranchAndBound,  ///< found the best pose exactly by branch and bound
  kLocal,           ///< local search from samples of the window, without generations
  kCoarse,          ///< ranked coarse cells exhaustively; no generations followed
  kCoarseGenetic,   ///< ranked coarse cells exhaustively, then ran generations in the best cells
  kGenetic,         ///< ran generations over the whole window
};

/// All searches.
inline constexpr std::array<SearchKind, 6> kSearchKinds{
    SearchKind::kExhaustive, SearchKind::kBranchAndBound, SearchKind::kLocal,
    SearchKind::kCoarse,     SearchKind::kCoarseGenetic,  SearchKind::kGenetic};

/// Name of a search in CSV, JSON and tables: "exhaustive", "branch_and_bound", "local", "coarse",
/// "coarse_genetic" or "genetic".
constexpr const char* name(SearchKind search) {
  constexpr std::array<const char*, kSearchKinds.size()> kNames{"exhaustive", "branch_and_bound", "local",
                                                                "coarse",     "coarse_genetic",   "genetic"};
  return kNames[static_cast<std::size_t>(search)];
}

/// Half-widths of the search window around a predicted pose, along the axes of the local map or map that is
/// searched.
struct SearchExtent {
  double x_m = 0;        ///< half-width along x, metres
  double y_m = 0;        ///< half-width along y, metres
  double theta_rad = 0;  ///< half-width in heading, radians
};

}  // namespace psi_slam
