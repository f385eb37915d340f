// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/simulation/simulation_random.h"

#include <algorithm>
#include <cmath>

namespace psi_slam {
namespace {

/// The finaliser of SplitMix64: neighbouring numbers become unlike ones.
std::uint64_t mixed(std::uint64_t value) {
  value += 0x9e3779b97f4a7c15;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9;
  value = (value ^ (value >> 27)) * 0x94d049bb133111eb;
  return value ^ (value >> 31);
}

}  // namespace

SimulationRandom::SimulationRandom(std::uint64_t seed, Stream stream, std::uint64_t index)
    : random_(mixed(mixed(mixed(seed) ^ static_cast<std::uint64_t>(stream)) ^ index)) {}

std::size_t SimulationRandom::below(std::size_t count) {
  return std::min(count - 1, static_cast<std::size_t>(share() * static_cast<double>(count)));
}

double SimulationRandom::normal() {
  const double radius = std::sqrt(-2 * std::log(1 - share()));
  return radius * std::cos(2 * M_PI * share());
}

}  // namespace psi_slam
