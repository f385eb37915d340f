// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "base/random_draws.h"

namespace psi_slam {

/// Random numbers of a simulation. The streams of one seed are independent of each other.
class SimulationRandom : public RandomDraws {
 public:
  enum class Stream : std::uint64_t { kFloorPlan, kRoute, kScan, kOdometry, kPeople, kRelations };

  /// `index` selects an independent part of a stream. Each scan has its own index, so its noise does not
  /// depend on other scans.
  SimulationRandom(std::uint64_t seed, Stream stream, std::uint64_t index = 0)
      : RandomDraws(mixed_bits(mixed_bits(mixed_bits(seed) ^ static_cast<std::uint64_t>(stream)) ^ index)) {}

  double between(double low, double high) { return low + (high - low) * share(); }
  bool happens(double probability) { return share() < probability; }
};

}  // namespace psi_slam
