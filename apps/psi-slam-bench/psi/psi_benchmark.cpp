// SPDX-License-Identifier: BSD-3-Clause
#include "psi/psi_benchmark.h"

#include <algorithm>

#include "base/number_text.h"
#include "map/exports/mapped_trajectory.h"
#include "psi_slam/open_log.h"

namespace psi_slam {
namespace {

PsiRun run_of(const BenchmarkLog& log, const std::string& matcher, std::uint64_t seed) {
  const Settings settings = benchmark_settings(
      log.ini, {"run.threads=1", "run.seed=" + std::to_string(seed), "loop_closure.matcher=" + matcher});
  const MeasuredMap map = map_measured(*open_log(log.log, log_options(settings)), mapper_options(settings));
  PsiRun run;
  run.log = log.name;
  run.matcher = matcher;
  run.figures = figures_of(map, trajectory_of(map.result.frames), read_relations(log.relations.value()));
  run.loops = loops_accepted(map.result);
  for (const auto& [kind, record] : map.result.loop_matchers)
    run.loop_matching_s += 1e-3 * record.effort.milliseconds;
  run.strata = psi_strata(map);
  for (const PsiStratum& stratum : run.strata)
    for (const double scan_ms : stratum.scan_ms) run.max_scan_ms = std::max(run.max_scan_ms, scan_ms);
  return run;
}

}  // namespace

std::size_t psi_stratum(double psi) {
  const auto* const bound = std::lower_bound(kPsiStrata.begin(), kPsiStrata.end(), psi);
  return static_cast<std::size_t>(bound - kPsiStrata.begin());
}

std::string psi_stratum_name(std::size_t stratum) {
  if (stratum == 0) return trimmed_text(kPsiStrata.front(), 2);
  const std::string low = trimmed_text(kPsiStrata[stratum - 1], 2);
  return stratum == kPsiStrata.size() ? "above " + low : low + " to " + trimmed_text(kPsiStrata[stratum], 2);
}

PsiStratum& PsiStratum::operator+=(const PsiStratum& other) {
  scans += other.scans;
  windows += other.windows;
  found += other.found;
  loops += other.loops;
  response_sum += other.response_sum;
  scan_ms.insert(scan_ms.end(), other.scan_ms.begin(), other.scan_ms.end());
  for (std::size_t i = 0; i < searches.size(); ++i) searches[i] += other.searches[i];
  return *this;
}

PsiStrata psi_strata(const MeasuredMap& map) {
  PsiStrata strata;
  const std::vector<FrameRecord>& frames = map.result.frames;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const FrameRecord& frame = frames[i];
    if (!frame.searched_loops) continue;
    PsiStratum& stratum = strata.at(psi_stratum(frame.psi));
    ++stratum.scans;
    stratum.windows += static_cast<std::size_t>(frame.loops_tried);
    stratum.loops += static_cast<std::size_t>(frame.loops_accepted);
    stratum.scan_ms.push_back(std::min(frame.loop_matching_ms, map.add_ms.at(i)));
    for (std::size_t k = 0; k < stratum.searches.size(); ++k)
      stratum.searches[k] += static_cast<std::size_t>(frame.searches[k]);
  }
  for (const LoopRecord& loop : map.result.loops) {
    if (loop.in_final_search || found_nothing(loop)) continue;
    PsiStratum& stratum = strata.at(psi_stratum(frames.at(loop.frame).psi));
    ++stratum.found;
    stratum.response_sum += loop.response;
  }
  return strata;
}

PsiBenchmark run_psi_benchmark(const std::vector<BenchmarkLog>& logs, const PsiBenchmarkOptions& options,
                               const ProgressObserver& observer) {
  PsiBenchmark benchmark;
  benchmark.identities = identities_of(logs);
  const auto all = static_cast<double>(logs.size() * options.matchers.size());
  for (const BenchmarkLog& log : logs)
    for (const std::string& matcher : options.matchers) {
      observer(log.name + ", " + matcher, static_cast<double>(benchmark.runs.size()), all);
      benchmark.runs.push_back(run_of(log, matcher, options.seed));
    }
  return benchmark;
}

}  // namespace psi_slam
