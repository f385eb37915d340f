// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace psi_slam {

/// The finaliser of SplitMix64 (Steele et al. 2014): neighbouring numbers become unlike ones. For seeds.
inline std::uint64_t mixed_bits(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9;
  number = (number ^ (number >> 27)) * 0x94d049bb133111eb;
  return number ^ (number >> 31);
}

}  // namespace psi_slam
