// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>

namespace psi_slam {

/// Returns the least processor time of `repeats` calls of `work`, in milliseconds. Other programs can only
/// make a call longer.
template <class Work>
double least_ms(std::size_t repeats, const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < repeats; ++i) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

}  // namespace psi_slam
