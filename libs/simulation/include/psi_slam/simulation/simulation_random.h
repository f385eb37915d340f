// SPDX-License-Identifier: BSD-3-Clause
// Random numbers of a simulation: the same for the same seed with every compiler and library, which the
// standard's distributions are not.
#pragma once

#include <cstddef>
#include <cstdint>
#include <random>

namespace psi_slam {

class SimulationRandom {
 public:
  /// What draws its numbers: streams of one seed have nothing in common.
  enum class Stream : std::uint64_t { kFloorPlan, kRoute, kScan, kOdometry, kPeople, kRelations };

  /// `index` tells apart parts of one stream: each scan has its own, so that no scan depends on another.
  SimulationRandom(std::uint64_t seed, Stream stream, std::uint64_t index = 0);

  /// In [0, 1).
  double share() { return static_cast<double>(random_() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * share(); }
  bool happens(double probability) { return share() < probability; }

  /// One of 0 .. count - 1; `count` is not 0.
  std::size_t below(std::size_t count);

  /// Of the normal distribution with mean 0 and standard deviation 1.
  double normal();

 private:
  std::mt19937_64 random_;
};

}  // namespace psi_slam
