// SPDX-License-Identifier: BSD-3-Clause
// Random numbers that are the same on every machine, unlike the distributions of the standard library.
#pragma once

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <random>
#include <string_view>
#include <vector>

#include "base/portable_math.h"

namespace psi_slam {

/// One step of SplitMix64 (Steele et al., 2014): maps neighbouring numbers to unrelated ones, for use as
/// seeds.
inline std::uint64_t mixed_bits(std::uint64_t number) {
  number += 0x9e3779b97f4a7c15;
  number = (number ^ (number >> 30)) * 0xbf58476d1ce4e5b9;
  number = (number ^ (number >> 27)) * 0x94d049bb133111eb;
  return number ^ (number >> 31);
}

class RandomDraws {
 public:
  /// Each combination of seed, name and part gives its own stream of numbers.
  RandomDraws(std::uint64_t seed, std::string_view name, std::uint32_t part) {
    std::vector<std::uint32_t> words{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32),
                                     part};
    for (const char letter : name) words.push_back(static_cast<unsigned char>(letter));
    std::seed_seq sequence(words.begin(), words.end());
    random_.seed(sequence);
  }

  /// Uniform random number in [0, 1).
  double share() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  /// Uniform random number in [-most, most).
  double plus_minus(double most) { return (2 * share() - 1) * most; }
  /// Uniform random index in [0, count); `count` must not be 0.
  std::size_t index(std::size_t count) {
    return static_cast<std::size_t>(share() * static_cast<double>(count));
  }
  /// Normally distributed random number with mean 0 and standard deviation 1, by the Box-Muller transform.
  double normal() {
    const double radius = std::sqrt(-2 * portable::log(1 - share()));
    return radius * portable::cos(2 * M_PI * share());
  }

 protected:
  explicit RandomDraws(std::uint64_t stream) : random_(stream) {}

 private:
  std::mt19937_64 random_;
};

}  // namespace psi_slam
