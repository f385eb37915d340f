// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/simulation_random.h"

#include "base/random_draws.h"

namespace psi_slam {

SimulationRandom::SimulationRandom(std::uint64_t seed, Stream stream, std::uint64_t index)
    : RandomDraws(mixed_bits(mixed_bits(mixed_bits(seed) ^ static_cast<std::uint64_t>(stream)) ^ index)) {}

}  // namespace psi_slam
