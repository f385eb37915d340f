// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace psi_slam {

/// What it cost to search for loops, whether any was found or not.
struct LoopEffort {
  std::size_t attempts = 0;      ///< windows searched
  std::size_t found = 0;         ///< of those, with a match: each is a LoopRecord
  std::int64_t evaluations = 0;  ///< poses scored
  double milliseconds = 0;       ///< of matching, added up over the attempts; verification is left out

  LoopEffort& operator+=(const LoopEffort& other) {
    attempts += other.attempts;
    found += other.found;
    evaluations += other.evaluations;
    milliseconds += other.milliseconds;
    return *this;
  }
};

}  // namespace psi_slam
