// SPDX-License-Identifier: BSD-3-Clause
// Random numbers of a simulation.
#pragma once

#include <cstdint>

#include "base/random_draws.h"

namespace psi_slam {

class SimulationRandom : public RandomDraws {
 public:
  /// What draws its numbers: streams of one seed have nothing in common.
  enum class Stream : std::uint64_t { kFloorPlan, kRoute, kScan, kOdometry, kPeople, kRelations };

  /// `index` tells apart parts of one stream: each scan has its own, so that no scan depends on another.
  SimulationRandom(std::uint64_t seed, Stream stream, std::uint64_t index = 0);

  double between(double low, double high) { return low + (high - low) * share(); }
  bool happens(double probability) { return share() < probability; }
};

}  // namespace psi_slam
