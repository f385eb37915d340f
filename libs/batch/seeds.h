// SPDX-License-Identifier: BSD-3-Clause
// Runs that differ only in their random seed: the range of seeds, and statistics of a figure over the runs.
#pragma once

#include <cstddef>
#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

namespace psi_slam {

/// The seeds first .. last, both included.
struct SeedRange {
  std::uint64_t first = 1;
  std::uint64_t last = 1;

  std::uint64_t count() const { return last - first + 1; }
  std::vector<std::uint64_t> all() const;
};

/// Reads a range of seeds: "10" as 1 to 10, "4-6" as 4 to 6. Throws UserError for any other text and for more
/// than a million seeds.
SeedRange parse_seeds(const std::string& text);

/// Text for messages: "seed 4", "seeds 4 to 6".
std::string seeds_text(const SeedRange& seeds);

/// Statistics of one figure over several runs. All members are 0 without values.
struct SeedSpread {
  std::size_t count = 0;  ///< number of values
  double mean = 0;
  double std = 0;  ///< standard deviation of the sample, divided by n - 1; 0 for a single value
  double min = 0;
  double max = 0;
};

SeedSpread spread_of(const std::vector<double>& values);

/// Statistics of `value_of(run)` over the runs.
template <class Run, class ValueOf>
SeedSpread spread_over(const std::vector<Run>& runs, const ValueOf& value_of) {
  std::vector<double> values;
  for (const Run& run : runs) values.push_back(static_cast<double>(value_of(run)));
  return spread_of(values);
}

/// Text of the statistics, such as "0.0412 ± 0.0010 [0.0431]": mean, standard deviation and greatest value.
/// Only the mean for a single value; "–" without values.
std::string spread_text(const SeedSpread& spread, int decimals);

/// JSON object {"mean": ..., "std": ..., "min": ..., "max": ...}; null without values.
nlohmann::ordered_json spread_json(const SeedSpread& spread);

/// Groups consecutive rows: a row joins a group if `same(first row of the group, row)` is true. The rows of a
/// group belong to one case and differ only in their seed.
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
