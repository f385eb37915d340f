// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace psi_slam {

/// The seeds first .. last of a benchmark's runs.
struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t last = 1;

  std::uint64_t count() const { return last - first + 1; }
  std::vector<std::uint64_t> all() const;
};

/// "10" is 1 to 10, "4-6" 4 to 6. Throws UserError for anything else, and for more than a million.
SeedRange parse_seeds(const std::string& text);

/// "seed 4", "seeds 4 to 6".
std::string seeds_text(const SeedRange& seeds);

}  // namespace psi_slam
