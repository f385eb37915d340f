// SPDX-License-Identifier: BSD-3-Clause
// The operators of the genetic searches (section 3.1 of the paper): roulette wheel, two-point crossover and
// bit-flip mutation. All random numbers come from the given generator.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

#include "matching/matcher.h"
#include "matching/pose_code.h"

namespace psi_slam {

using Random = std::mt19937_64;

/// Returns the random generator of one match. Equal seeds give equal generators.
Random random_for(const MatchSeed& seed);

/// Draws an integer in [0, count) uniformly, with count > 0. The result is the same on every platform.
std::uint64_t draw_below(std::uint64_t count, Random& random);

/// Draws a multiple of 2^-53 in [0, 1) uniformly.
double draw_unit(Random& random);

/// Draws individuals with probabilities proportional to their fitness; uniformly if all fitness values are 0.
class RouletteWheel {
 public:
  /// Builds the wheel. `fitness` must have at least one entry, and no negative entry.
  explicit RouletteWheel(const std::vector<double>& fitness);

  /// Returns the index of the individual that was drawn.
  std::size_t spin(Random& random) const;

 private:
  std::vector<double> up_to_;  ///< cumulative fitness
};

/// Exchanges the bits of `a` and `b` between two cuts. Draws the cuts uniformly from all pairs 0 <= first <
/// last <= bits.
std::pair<Chromosome, Chromosome> two_point_crossover(Chromosome a, Chromosome b, int bits, Random& random);

/// Flips each of the lowest `bits` bits with probability `rate`.
Chromosome mutate(Chromosome chromosome, int bits, double rate, Random& random);

}  // namespace psi_slam
