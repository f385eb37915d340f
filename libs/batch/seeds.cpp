// SPDX-License-Identifier: BSD-3-Clause
#include "batch/seeds.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/number_text.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::uint64_t kMostSeeds = 1'000'000;

[[noreturn]] void refuse(const std::string& text) {
  throw UserError("--seeds: expected N for the seeds 1 to N, or FIRST-LAST, at most " +
                  std::to_string(kMostSeeds) + " seeds: " + text);
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

SeedSpread spread_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto count = static_cast<double>(values.size());
  SeedSpread spread;
  spread.count = values.size();
  spread.mean = std::accumulate(values.begin(), values.end(), 0.0) / count;
  double squares = 0;
  for (const double value : values) squares += (value - spread.mean) * (value - spread.mean);
  if (values.size() > 1) spread.std = std::sqrt(squares / (count - 1));
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  spread.min = *least;
  spread.max = *most;
  return spread;
}

std::string spread_text(const SeedSpread& spread, int decimals) {
  if (spread.count == 0) return "–";
  const std::string mean = fixed_text(spread.mean, decimals);
  if (spread.count == 1) return mean;
  return mean + " ± " + fixed_text(spread.std, decimals) + " [" + fixed_text(spread.max, decimals) + ']';
}

nlohmann::ordered_json spread_json(const SeedSpread& spread) {
  if (spread.count == 0) return nullptr;
  return {{"mean", spread.mean}, {"std", spread.std}, {"min", spread.min}, {"max", spread.max}};
}

}  // namespace psi_slam
