// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baseline_benchmark.h"

#include <nlohmann/json.hpp>

#include "base/file_checksum.h"
#include "base/worker_pool.h"
#include "batch/kept_run.h"
#include "batch/provenance.h"
#include "common/bench_report.h"
#include "freiburg/freiburg_run.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kUnfinished = "not_finished_in_s";

struct Task {
  BaselineRun run;
  fs::path file;
  RunKey key;
  double work = 0;
  BaselineResult* result = nullptr;
};

/// Includes the settings of our reader, which provides the input. Does not include the checksum of this
/// program, so that a new build does not repeat the runs.
std::string key_of(const BaselineRun& run) {
  std::string text = machine_text() + '\n' + sha256_of_file(run.log.log) + '\n' +
                     sha256_of_file(run.log.relations.value()) + '\n' + program_version() + '\n' +
                     settings_text(benchmark_settings(run.log.ini));
  text +=
      run.baseline.version + '\n' + run.baseline.sha256 + '\n' + baseline_settings(run.baseline, "output");
  return sha256_of_text(text);
}

/// Reads a kept result. Returns false if the run must be made.
bool read_kept(const Task& task, BaselineResult& result) {
  const std::optional<Json> kept = kept_run(task.file, task.key);
  if (!kept) return false;
  try {
    if (kept->contains("figures")) {
      result.figures = read_run_figures(kept->at("figures"));
      return true;
    }
    const double limit_s = kept->at(kUnfinished).get<double>();
    if (limit_s < task.run.time_limit_s) return false;
    result.not_finished_in_s = limit_s;
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

/// Keeps a result. A failure is not kept, so that the run is repeated.
void keep(const Task& task, const BaselineResult& result) {
  if (!result.figures && !result.not_finished_in_s) return;
  Json content = {{"schema", "psi-slam-rival-run"},
                  {"schema_version", 1},
                  {"log", result.log},
                  {"rival", result.baseline},
                  {"version", task.run.baseline.version},
                  {"machine", machine_text()}};
  if (result.figures) content["figures"] = run_figures_json(*result.figures);
  if (result.not_finished_in_s) content[kUnfinished] = *result.not_finished_in_s;
  keep_run(task.file, task.key, content);
}

/// The runs without kept results. Fills in the kept results of the others.
std::vector<Task> tasks_of(const std::vector<BaselineProgram>& baselines,
                           const std::vector<BenchmarkLog>& logs, const BaselineOptions& options,
                           std::vector<BaselineResult>& results) {
  std::vector<Task> tasks;
  results.resize(logs.size() * baselines.size());
  auto result = results.begin();
  for (const BenchmarkLog& log : logs)
    for (const BaselineProgram& baseline : baselines) {
      const std::string name = log.name + '-' + baseline.kind.name;
      Task task;
      task.run = {baseline, log, options.output / "rivals" / name, options.time_limit_s};
      task.file = options.output / "runs" / (name + ".json");
      task.key = {key_of(task.run), options.processes};
      task.work = static_cast<double>(fs::file_size(log.log));
      task.result = &*result++;
      task.result->log = log.name;
      task.result->baseline = baseline.kind.name;
      if (!read_kept(task, *task.result)) tasks.push_back(std::move(task));
    }
  return tasks;
}

}  // namespace

std::vector<BaselineResult> run_baselines(const std::vector<BaselineProgram>& baselines,
                                          const std::vector<BenchmarkLog>& logs,
                                          const BaselineOptions& options, const std::atomic<bool>& stop,
                                          const ProgressObserver& observer) {
  std::vector<BaselineResult> results;
  const std::vector<Task> tasks = tasks_of(baselines, logs, options, results);
  double work = 0;
  for (const Task& task : tasks) work += task.work;
  TaskProgress progress(tasks.size(), work, observer);
  WorkerPool pool(options.processes);
  pool.run(tasks.size(), [&](std::size_t index) {
    if (stop) return;
    const Task& task = tasks[index];
    const BaselineResult result = run_baseline(task.run, [&] {
      progress.show(task.run.baseline.kind.name + " on " + task.run.log.name);
      return stop.load();
    });
    if (stop && !result.figures) return;
    keep(task, result);
    *task.result = result;
    progress.end(task.work);
  });
  if (stop && progress.remaining() > 0)
    throw SystemFailure("interrupted with " + std::to_string(progress.remaining()) +
                        " runs of baselines to go: finished runs are kept; repeat the command to continue");
  return results;
}

}  // namespace psi_slam
