// SPDX-License-Identifier: BSD-3-Clause
// How a figure spreads over runs that differ by their seeds only.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace psi_slam {

struct SeedSpread {
  std::size_t count = 0;  ///< of the values
  double mean = 0;
  double std = 0;  ///< of a sample: divided by n - 1; 0 of one value, which does not spread
  double min = 0;
  double max = 0;
};

/// All 0 where there are no values.
SeedSpread spread_of(const std::vector<double>& values);

/// Of what `value_of` takes from each of the runs.
template <class Run, class ValueOf>
SeedSpread spread_over(const std::vector<Run>& runs, const ValueOf& value_of) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(static_cast<double>(value_of(run)));
  return spread_of(values);
}

/// "0.0412 ± 0.0010 [0.0431]": mean, deviation and the worst, which is the greatest; of one value that alone,
/// of none "–".
std::string spread_text(const SeedSpread& spread, int decimals);

/// {"mean": ..., "std": ..., "min": ..., "max": ...}
nlohmann::ordered_json spread_json(const SeedSpread& spread);

/// Rows in which `same` finds no difference but the seed, together; they stand one behind the other.
template <class Row, class Same>
std::vector<std::vector<Row>> by_case(const std::vector<Row>& rows, const Same& same) {
  std::vector<std::vector<Row>> cases;
  for (const Row& row : rows) {
    if (cases.empty() || !same(cases.back().front(), row)) cases.emplace_back();
    cases.back().push_back(row);
  }
  return cases;
}

/// The seeds of the rows of a case.
template <class Row>
std::vector<std::uint64_t> seeds_of(const std::vector<Row>& rows) {
  std::vector<std::uint64_t> seeds;
  for (const Row& row : rows) seeds.push_back(row.seed);
  return seeds;
}

}  // namespace psi_slam
