// SPDX-License-Identifier: BSD-3-Clause
#include "batch/seed_spread.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <numeric>

#include "base/number_text.h"

namespace psi_slam {

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
  return {{"mean", spread.mean}, {"std", spread.std}, {"min", spread.min}, {"max", spread.max}};
}

}  // namespace psi_slam
