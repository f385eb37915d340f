// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <ctime>
#include <limits>

namespace psi_slam {

/// Returns the processor time of a call of `work`, in milliseconds.
template <class Work>
double processor_ms(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

/// Returns the least processor time of `repeats` calls of `work`, in milliseconds. Other programs can only
/// make a call longer.
template <class Work>
double least_ms(std::size_t repeats, const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < repeats; ++i) least = std::min(least, processor_ms(work));
  return least;
}

}  // namespace psi_slam
