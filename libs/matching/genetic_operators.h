// SPDX-License-Identifier: BSD-3-Clause
// The operators of the genetic searches (section 3.1 of the paper): roulette wheel, two-point crossover,
// bit-flip mutation. All randomness comes from the generator that is passed in.
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

/// The generator of one match: the same for the same seed, whatever else runs.
Random random_for(const MatchSeed& seed);

/// A whole number below `count` > 0, all equally likely; the same on every platform.
std::uint64_t draw_below(std::uint64_t count, Random& random);

/// A number in [0, 1), a multiple of 2^-53.
double draw_unit(Random& random);

/// Draws individuals in proportion to their fitness; all equally likely when none has any.
class RouletteWheel {
 public:
  /// Of at least one individual, none less than 0.
  explicit RouletteWheel(const std::vector<double>& fitness);

  std::size_t spin(Random& random) const;

 private:
  std::vector<double> up_to_;  ///< fitness of the individuals up to each, itself included
};

/// Exchanges the bits between two cuts, which are drawn from all pairs 0 <= first < last <= bits.
std::pair<Chromosome, Chromosome> two_point_crossover(Chromosome a, Chromosome b, int bits, Random& random);

/// Flips each of the lowest `bits` bits with probability `rate`.
Chromosome mutate(Chromosome chromosome, int bits, double rate, Random& random);

}  // namespace psi_slam
