// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_operators.h"

#include <algorithm>

#include "base/random_draws.h"

namespace psi_slam {

Random random_for(const MatchSeed& seed) {
  return Random(mixed_bits(mixed_bits(mixed_bits(seed.run) + seed.scan) + seed.local_map));
}

// Uses the method of Lemire, "Fast random integer generation in an interval", 2019.
std::uint64_t draw_below(std::uint64_t count, Random& random) {
  __extension__ using Wide = unsigned __int128;
  Wide product = static_cast<Wide>(random()) * count;
  if (static_cast<std::uint64_t>(product) < count) {
    const std::uint64_t uneven = (0 - count) % count;
    while (static_cast<std::uint64_t>(product) < uneven) product = static_cast<Wide>(random()) * count;
  }
  return static_cast<std::uint64_t>(product >> 64);
}

double draw_unit(Random& random) {
  return static_cast<double>(random() >> 11) * 0x1p-53;
}

RouletteWheel::RouletteWheel(const std::vector<double>& fitness) {
  double sum = 0;
  for (const double one : fitness) up_to_.push_back(sum += one);
  if (sum > 0) return;
  for (std::size_t i = 0; i < up_to_.size(); ++i) up_to_[i] = static_cast<double>(i + 1);
}

std::size_t RouletteWheel::spin(Random& random) const {
  const double at = draw_unit(random) * up_to_.back();
  const auto found = std::upper_bound(up_to_.begin(), up_to_.end(), at);
  return static_cast<std::size_t>(std::min(found, up_to_.end() - 1) - up_to_.begin());
}

std::pair<Chromosome, Chromosome> two_point_crossover(Chromosome a, Chromosome b, int bits, Random& random) {
  const auto cuts = static_cast<std::uint64_t>(bits) + 1;
  std::uint64_t first = draw_below(cuts, random);
  std::uint64_t last = draw_below(cuts - 1, random);
  if (last >= first) ++last;
  if (first > last) std::swap(first, last);
  const Chromosome below_last = last >= 64 ? ~Chromosome{0} : (Chromosome{1} << last) - 1;
  const Chromosome between = below_last & ~((Chromosome{1} << first) - 1);
  const Chromosome exchanged = (a ^ b) & between;
  return {a ^ exchanged, b ^ exchanged};
}

Chromosome mutate(Chromosome chromosome, int bits, double rate, Random& random) {
  for (int bit = 0; bit < bits; ++bit)
    if (draw_unit(random) < rate) chromosome ^= Chromosome{1} << bit;
  return chromosome;
}

}  // namespace psi_slam
