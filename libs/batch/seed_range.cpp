// SPDX-License-Identifier: BSD-3-Clause
#include "batch/seed_range.h"

#include <charconv>
#include <numeric>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::uint64_t kMostSeeds = 1'000'000;

[[noreturn]] void refuse(const std::string& text) {
  throw UserError("--seeds: expected N for the seeds 1 to N, or FIRST-LAST, at most " +
                  std::to_string(kMostSeeds) + " of them: " + text);
}

std::uint64_t number_of(const std::string& digits, const std::string& text) {
  std::uint64_t number = 0;
  const char* const end = digits.data() + digits.size();
  const auto [rest, error] = std::from_chars(digits.data(), end, number);
  if (error != std::errc() || rest != end) refuse(text);
  return number;
}

}  // namespace

std::vector<std::uint64_t> SeedRange::all() const {
  std::vector<std::uint64_t> seeds(count());
  std::iota(seeds.begin(), seeds.end(), first);
  return seeds;
}

SeedRange parse_seeds(const std::string& text) {
  const std::size_t dash = text.find('-');
  SeedRange seeds;
  if (dash != std::string::npos) seeds.first = number_of(text.substr(0, dash), text);
  seeds.last = number_of(dash == std::string::npos ? text : text.substr(dash + 1), text);
  if (seeds.last < seeds.first || seeds.last - seeds.first >= kMostSeeds) refuse(text);
  return seeds;
}

std::string seeds_text(const SeedRange& seeds) {
  const std::string first = std::to_string(seeds.first);
  return seeds.count() == 1 ? "seed " + first : "seeds " + first + " to " + std::to_string(seeds.last);
}

}  // namespace psi_slam
