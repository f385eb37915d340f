// SPDX-License-Identifier: BSD-3-Clause
// Neighbouring beams of a scan, and neighbouring points of a sequence. In a scan of a full circle, the first
// and the last beam are neighbours, too.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace psi_slam {

/// Returns whether the first and the last beam of a scan are neighbours: their bearings differ by a full
/// circle, except for 2.5 steps between beams or 0.2 rad. The bearings of slices of point clouds scatter by
/// one step, and the ends of a sweep overlap or gape by the robot's turn once its motion is removed.
inline bool is_full_circle(const std::vector<float>& bearings_rad) {
  if (bearings_rad.size() < 3) return false;
  constexpr double kMaxSteps = 2.5;
  constexpr double kMaxTurn_rad = 0.2;
  const double span_rad =
      static_cast<double>(bearings_rad.back()) - static_cast<double>(bearings_rad.front());
  const double step_rad = std::abs(span_rad) / static_cast<double>(bearings_rad.size() - 1);
  return std::abs(span_rad) > M_PI &&
         std::abs(std::remainder(span_rad, 2 * M_PI)) <= std::max(kMaxSteps * step_rad, kMaxTurn_rad);
}

/// Successive elements of a sequence. On a ring, the element after the last is the first, and `first` may be
/// negative and `last` beyond the end: see index_on_ring().
struct Neighbourhood {
  std::ptrdiff_t first = 0;
  std::ptrdiff_t last = 0;

  std::ptrdiff_t count() const { return last - first + 1; }
};

/// Returns the index of an element that is at most one round away from the sequence.
inline std::size_t index_on_ring(std::ptrdiff_t i, std::size_t size) {
  const auto end = static_cast<std::ptrdiff_t>(size);
  return static_cast<std::size_t>(i < 0 ? i + end : i >= end ? i - end : i);
}

/// Returns the neighbourhood of an element: at most `reach` elements on each side, and each element at most
/// once. `are_joined(near, far)` tells whether the neighbourhood continues from one element to the next one
/// farther from `index`.
template <class AreJoined>
Neighbourhood neighbourhood(std::size_t index, std::size_t size, std::ptrdiff_t reach, bool is_ring,
                            AreJoined are_joined) {
  const auto i = static_cast<std::ptrdiff_t>(index);
  const auto end = static_cast<std::ptrdiff_t>(size);
  const auto joins = [&](std::ptrdiff_t a, std::ptrdiff_t b) {
    return are_joined(index_on_ring(a, size), index_on_ring(b, size));
  };
  Neighbourhood found{i, i};
  while ((is_ring ? found.count() < end : found.first > 0) && i - found.first < reach &&
         joins(found.first, found.first - 1))
    --found.first;
  while ((is_ring ? found.count() < end : found.last + 1 < end) && found.last - i < reach &&
         joins(found.last, found.last + 1))
    ++found.last;
  return found;
}

}  // namespace psi_slam
