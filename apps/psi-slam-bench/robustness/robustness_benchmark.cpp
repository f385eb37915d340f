// SPDX-License-Identifier: BSD-3-Clause
#include "robustness/robustness_benchmark.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "base/degrees.h"
#include "base/number_text.h"
#include "evaluation/loop_judgement.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

bool is_the_log_itself(const DegradationOptions& degradation) {
  return degradation.odometry_noise_scale <= 1 && degradation.keep_every_nth == 1 &&
         !degradation.field_of_view_rad && !degradation.no_odometry;
}

OdometryNoise natural_noise(const std::vector<FrameRecord>& frames) {
  std::vector<mrpt::math::TPose2D> odometry;
  std::vector<mrpt::math::TPose2D> map;
  for (const FrameRecord& frame : frames) {
    odometry.push_back(frame.odom_T_robot);
    map.push_back(frame.map_T_robot);
  }
  return measure_odometry_noise(odometry, map);
}

RobustnessRow row_of(const MappingResult& result, const std::vector<Relation>& relations) {
  RobustnessRow row;
  const RelationsMetric metric = error_of(result.frames, relations);
  row.translation_error_m = metric.translation_abs_m.mean;
  row.rotation_error_deg = metric.rotation_abs_deg.mean;
  row.relations = metric.exact + metric.interpolated;
  row.scans = result.frames.size();
  for (std::size_t i = 1; i < result.frames.size(); ++i)
    row.unmatched += result.frames[i].response > 0 ? 0 : 1;
  const LoopJudgement judgement = judge_loops(result, relations);
  row.loops = judgement.judged.size() + judgement.unjudged;
  row.loop_precision = judgement.precision();
  row.loop_recall = judgement.recall();
  return row;
}

/// The cases of one log.
class LogRuns {
 public:
  LogRuns(const BenchmarkLog& log, std::function<void(const std::string& doing, double share)> progress)
      : log_(log),
        settings_(benchmark_settings(log.ini)),
        relations_(read_relations(log.relations.value())),
        progress_(std::move(progress)) {
    const MappingResult result = map({}, "as it is");
    natural_ = natural_noise(result.frames);
    as_it_is_ = row_of(result, relations_);
  }

  const OdometryNoise& natural() const { return natural_; }

  RobustnessRow run(RobustnessCase degraded) const {
    degraded.degradation.natural_noise = natural_;
    RobustnessRow row =
        is_the_log_itself(degraded.degradation)
            ? as_it_is_
            : row_of(map(degraded.degradation, degraded.series + ' ' + degraded.name), relations_);
    row.log = log_.name;
    row.seed = degraded.degradation.seed;
    row.degraded = std::move(degraded);
    return row;
  }

 private:
  MappingResult map(const DegradationOptions& degradation, const std::string& doing) const {
    DegradedSource source(open_log(log_.log, log_options(settings_)), degradation);
    return map_source(source, mapper_options(settings_),
                      [&](double share) { progress_(log_.name + ", " + doing, share); })
        .result;
  }

  BenchmarkLog log_;
  Settings settings_;
  std::vector<Relation> relations_;
  std::function<void(const std::string&, double)> progress_;
  OdometryNoise natural_;
  RobustnessRow as_it_is_;
};

/// The cases in order, with all seeds if they draw random numbers, otherwise with the first.
std::vector<RobustnessCase> runs_of(const SeedRange& seeds) {
  std::vector<RobustnessCase> runs;
  for (RobustnessCase degraded : robustness_cases(seeds.first))
    for (const std::uint64_t seed : seeds.all()) {
      if (seed > seeds.first && !draws_random_numbers(degraded)) break;
      degraded.degradation.seed = seed;
      runs.push_back(degraded);
    }
  return runs;
}

}  // namespace

std::vector<RobustnessCase> robustness_cases(std::uint64_t seed) {
  std::vector<RobustnessCase> cases;
  DegradationOptions as_it_is;
  as_it_is.seed = seed;
  for (const double scale : {1.0, 2.0, 4.0}) {
    cases.push_back({"odometry noise", "× " + fixed_text(scale, 0), as_it_is});
    cases.back().degradation.odometry_noise_scale = scale;
  }
  cases.push_back({"odometry noise", "no odometry", as_it_is});
  cases.back().degradation.no_odometry = true;
  for (const std::size_t nth : {1U, 2U, 3U, 5U}) {
    cases.push_back({"scans kept", "1 of " + std::to_string(nth), as_it_is});
    cases.back().degradation.keep_every_nth = nth;
  }
  cases.push_back({"field of view", "full", as_it_is});
  cases.push_back({"field of view", "90°", as_it_is});
  cases.back().degradation.field_of_view_rad = radians_from_degrees(90.0L);
  return cases;
}

bool draws_random_numbers(const RobustnessCase& degraded) {
  return degraded.degradation.odometry_noise_scale > 1;
}

RobustnessBenchmark run_robustness_benchmark(const std::vector<BenchmarkLog>& logs, const SeedRange& seeds,
                                             const ProgressObserver& observer) {
  const std::vector<RobustnessCase> runs = runs_of(seeds);
  const auto own = std::count_if(runs.begin(), runs.end(), [](const RobustnessCase& degraded) {
    return !is_the_log_itself(degraded.degradation);
  });
  const double all = static_cast<double>(logs.size()) * static_cast<double>(own + 1);
  double done = 0;
  const auto progress = [&](const std::string& doing, double share) { observer(doing, done + share, all); };
  RobustnessBenchmark benchmark;
  benchmark.identities = identities_of(logs);
  for (const BenchmarkLog& log : logs) {
    const LogRuns log_runs(log, progress);
    ++done;
    benchmark.logs.push_back({log.name, log_runs.natural()});
    for (const RobustnessCase& degraded : runs) {
      benchmark.rows.push_back(log_runs.run(degraded));
      if (!is_the_log_itself(degraded.degradation)) ++done;
    }
  }
  return benchmark;
}

}  // namespace psi_slam
