// SPDX-License-Identifier: BSD-3-Clause
// Evaluates equation 1 in its simplest form: three loops over the window, one over the points.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "matching/search_lattice.h"

namespace psi_slam {

inline std::uint32_t slow_sum(const SearchLattice& lattice, const LatticePose& pose) {
  std::uint32_t sum = 0;
  for (std::size_t p = 0; p < lattice.points(); ++p) {
    const Cell cell = lattice.cells(pose.theta)[p];
    sum += lattice.grid().finest().at(cell.x + pose.x, cell.y + pose.y);
  }
  return sum;
}

/// Returns the pose outside `excluded` with the highest sum, if this sum reaches `min_sum`. Of poses with
/// equal sums, takes the one nearest to the centre in steps, then with the lowest theta, then y, then x.
inline std::optional<Candidate> slow_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                            const std::optional<ExcludedRegion>& excluded = {}) {
  const SearchWindow& window = lattice.window();
  std::vector<Candidate> highest;
  for (int theta = -window.n_theta; theta <= window.n_theta; ++theta) {
    for (int y = -window.n_y; y <= window.n_y; ++y) {
      for (int x = -window.n_x; x <= window.n_x; ++x) {
        const Candidate candidate = {slow_sum(lattice, {x, y, theta}), {x, y, theta}};
        if (candidate.sum < min_sum) continue;
        if (excluded && excluded->contains(candidate.pose)) continue;
        if (!highest.empty() && candidate.sum < highest.front().sum) continue;
        if (!highest.empty() && candidate.sum > highest.front().sum) highest.clear();
        highest.push_back(candidate);
      }
    }
  }
  std::optional<Candidate> best;
  const auto order = [](const LatticePose& p) {
    return std::tuple(p.x * p.x + p.y * p.y + p.theta * p.theta, p.theta, p.y, p.x);
  };
  for (const Candidate& candidate : highest)
    if (!best || order(candidate.pose) < order(best->pose)) best = candidate;
  return best;
}

inline bool same(const std::optional<Candidate>& a, const std::optional<Candidate>& b) {
  if (!a || !b) return !a && !b;
  return a->sum == b->sum && a->pose.x == b->pose.x && a->pose.y == b->pose.y &&
         a->pose.theta == b->pose.theta;
}

/// Returns a candidate as text, for messages of failed tests.
inline std::string to_text(const std::optional<Candidate>& candidate) {
  if (!candidate) return "none";
  const LatticePose& pose = candidate->pose;
  return std::to_string(candidate->sum) + " at (" + std::to_string(pose.x) + ", " + std::to_string(pose.y) +
         ", " + std::to_string(pose.theta) + ")";
}

}  // namespace psi_slam
