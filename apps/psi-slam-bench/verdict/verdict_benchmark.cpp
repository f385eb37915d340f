// SPDX-License-Identifier: BSD-3-Clause
#include "verdict/verdict_benchmark.h"

#include <algorithm>

#include "common/processor_time.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {

VerdictRow judged(const FaultyMap& map) {
  MapVerdict verdict;
  VerdictRow row;
  row.judge_ms = processor_ms([&] { verdict = judge_map(map.result); });
  row.log = map.log;
  row.fault = map.fault;
  row.seed = map.seed;
  row.error_m = map.error_m;
  row.map_distance_m = map.distance_m;
  row.state = verdict.state;
  row.doubt_m = verdict.doubt_m();
  row.hot_spots = verdict.hot_spots.size();
  if (verdict.hot_spots.empty()) return row;
  const Suspect& suspect = verdict.hot_spots.front().suspect;
  if (is_false_loop(map.fault) && suspect.kind != Suspect::Kind::kLoop) return row;
  for (const mrpt::math::TPoint2D& place : map.places) {
    const double away_m = distance_m(suspect.at, place);
    row.distance_m = std::min(row.distance_m.value_or(away_m), away_m);
  }
  return row;
}

std::vector<VerdictRow> run_verdict_benchmark(const std::vector<BenchmarkLog>& logs,
                                              const VerdictBenchmarkOptions& options,
                                              const ProgressObserver& observer) {
  const std::size_t maps_of_log = 1 + options.log_seeds.count() * (kMapFaults.size() - 1);
  const auto all = static_cast<double>(options.seeds.count() * kMapFaults.size() + logs.size() * maps_of_log);
  std::vector<VerdictRow> rows;
  const auto judge = [&](const FaultyMap& map) {
    rows.push_back(judged(map));
    observer(
        (map.log.empty() ? "building" : map.log) + ' ' + std::to_string(map.seed) + ", " + name_of(map.fault),
        static_cast<double>(rows.size()), all);
  };
  for (const std::uint64_t seed : options.seeds.all()) make_simulated_maps(seed, options.path_m, judge);
  for (const BenchmarkLog& log : logs) make_maps_of_log(log, options.log_seeds, judge);
  return rows;
}

std::optional<double> area_under_curve(const std::vector<VerdictRow>& rows) {
  double wins = 0;
  std::size_t pairs = 0;
  for (const VerdictRow& wrong : rows) {
    if (wrong.error_m <= kWrongMap_m) continue;
    for (const VerdictRow& right : rows) {
      if (right.error_m > kRightMap_m) continue;
      ++pairs;
      wins += wrong.doubt_m > right.doubt_m ? 1 : wrong.doubt_m < right.doubt_m ? 0 : 0.5;
    }
  }
  if (pairs == 0) return std::nullopt;
  return wins / static_cast<double>(pairs);
}

bool is_fault_to_locate(const VerdictRow& row) {
  return has_one_place(row.fault) && row.error_m > kRightMap_m;
}

}  // namespace psi_slam
