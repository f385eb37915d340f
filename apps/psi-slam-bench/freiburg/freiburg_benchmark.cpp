// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_benchmark.h"

#include <nlohmann/json.hpp>

#include "base/file_checksum.h"
#include "batch/kept_run.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A run with its place in the benchmark.
struct Task {
  FreiburgRun run;
  std::string name;  // "intel-csm-1"
  fs::path file;     // for its result
  RunKey key;
  double work = 0;  // bytes of the log
  const LogIdentity* log = nullptr;
  FreiburgResult* result = nullptr;
};

std::string key_of(const FreiburgRun& run, const LogIdentity& log, const std::string& program_sha256) {
  return sha256_of_text(machine_text() + '\n' + log.sha256 + '\n' + log.relations_sha256 + '\n' +
                        program_version() + '\n' + program_sha256 + '\n' + settings_text(settings_of(run)));
}

/// The figures in the file of an earlier run with the same key.
std::optional<FreiburgFigures> kept_figures(const Task& task) {
  const std::optional<Json> kept = kept_run(task.file, task.key);
  if (!kept || !kept->contains("figures")) return std::nullopt;
  return read_figures(kept->at("figures").dump());
}

void keep_figures(const Task& task, const FreiburgFigures& figures) {
  const LogIdentity& log = *task.log;
  keep_run(task.file, task.key,
           {{"schema", "psi-slam-freiburg-run"},
            {"schema_version", 1},
            {"log", log.name},
            {"log_sha256", log.sha256},
            {"relations_sha256", log.relations_sha256},
            {"matcher", task.run.matcher},
            {"seed", task.run.seed},
            {"threads", task.run.threads},
            {"machine", machine_text()},
            {"program_version", program_version()},
            {"commit", program_commit()},
            {"figures", Json::parse(figures_json(figures))},
            {"settings", settings_text(settings_of(task.run))}});
}

ChildWords words_of(const FreiburgRun& run, const fs::path& program) {
  return {program.string(), "freiburg-run",
          "--log",          run.log.string(),
          "--ini",          run.ini.string(),
          "--relations",    run.relations.string(),
          "--matcher",      run.matcher,
          "--seed",         std::to_string(run.seed),
          "--threads",      std::to_string(run.threads)};
}

/// The figures of a finished run with its time and memory, or the reason of its failure.
FreiburgResult result_of(const ChildEnd& end, std::uint64_t seed) {
  FreiburgResult result;
  result.seed = seed;
  result.made = true;
  result.failure = end.failure_without("psi-slam-bench: ");
  if (!result.failure.empty()) return result;
  result.figures = read_figures(end.out);
  if (!result.figures) {
    result.failure = "the run printed no figures";
    return result;
  }
  set_effort(*result.figures, end);
  return result;
}

FreiburgRun run_of(const BenchmarkLog& log, const std::string& matcher, std::uint64_t seed, int threads) {
  return {log.log, log.ini, log.relations.value(), matcher, seed, threads};
}

/// All cells, without results.
FreiburgBenchmark plan(const std::vector<BenchmarkLog>& logs, const FreiburgOptions& options) {
  FreiburgBenchmark benchmark;
  benchmark.logs = identities_of(logs);
  for (const BenchmarkLog& log : logs) {
    for (const std::string& matcher : options.matchers) {
      FreiburgCell cell{log.name, matcher, {}};
      cell.runs.resize(draws_random_numbers(matcher) ? options.seeds.count() : 1);
      for (std::size_t i = 0; i < cell.runs.size(); ++i) cell.runs[i].seed = options.seeds.first + i;
      benchmark.cells.push_back(std::move(cell));
    }
  }
  return benchmark;
}

/// The runs without kept results. Fills in the kept results of the others.
std::vector<Task> tasks_of(FreiburgBenchmark& benchmark, const std::vector<BenchmarkLog>& logs,
                           const FreiburgOptions& options) {
  const std::string program_sha256 = sha256_of_file(options.program);
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < benchmark.cells.size(); ++i) {
    const std::size_t log = i / options.matchers.size();
    for (FreiburgResult& result : benchmark.cells[i].runs) {
      Task task;
      task.run = run_of(logs[log], benchmark.cells[i].matcher, result.seed, options.threads);
      task.name = logs[log].name + '-' + task.run.matcher + '-' + std::to_string(result.seed);
      task.file = options.output / "runs" / (task.name + ".json");
      task.key = {key_of(task.run, benchmark.logs[log], program_sha256), options.processes};
      task.work = static_cast<double>(fs::file_size(logs[log].log));
      task.log = &benchmark.logs[log];
      task.result = &result;
      result.figures = kept_figures(task);
      if (!result.figures) tasks.push_back(std::move(task));
    }
  }
  return tasks;
}

/// Fills in the result of a finished task, and keeps its figures.
void take(const Task& task, const ChildEnd& end, TaskProgress& progress) {
  const FreiburgResult result = result_of(end, task.run.seed);
  if (result.figures) keep_figures(task, *result.figures);
  *task.result = result;
  progress.end(task.work);
}

std::optional<SeedSpread> recall_of(const std::vector<FreiburgFigures>& runs) {
  std::vector<double> recalls;
  for (const FreiburgFigures& run : runs)
    if (run.loop_recall) recalls.push_back(*run.loop_recall);
  if (recalls.empty()) return std::nullopt;
  return spread_of(recalls);
}

}  // namespace

std::optional<CellFigures> figures_of(const FreiburgCell& cell) {
  std::vector<FreiburgFigures> runs;
  for (const FreiburgResult& run : cell.runs)
    if (run.figures) runs.push_back(*run.figures);
  if (runs.empty()) return std::nullopt;
  const auto over_seeds = [&runs](const auto& value_of) { return spread_over(runs, value_of); };
  CellFigures figures;
  figures.runs = runs.size();
  figures.failed = cell.runs.size() - runs.size();
  for (std::size_t i = 0; i < kPathFigures.size(); ++i) {
    const auto errors = kPathFigures[i].errors;
    figures.spread[i] = over_seeds([&](const FreiburgFigures& run) { return (run.errors.*errors).mean; });
    figures.errors.*errors = {figures.spread[i].mean, over_seeds([&](const FreiburgFigures& run) {
                                                        return (run.errors.*errors).std;
                                                      }).mean};
  }
  figures.relations_used = over_seeds([](const FreiburgFigures& run) { return run.relations_used; }).mean;
  figures.relations_skipped =
      over_seeds([](const FreiburgFigures& run) { return run.relations_skipped; }).mean;
  figures.loops_accepted = over_seeds([](const FreiburgFigures& run) { return run.loops_accepted; });
  figures.loops_judged = over_seeds([](const FreiburgFigures& run) { return run.loops_judged; });
  figures.loops_false = over_seeds([](const FreiburgFigures& run) { return run.loops_false; });
  figures.loop_recall = recall_of(runs);
  figures.wall_s = over_seeds([](const FreiburgFigures& run) { return run.wall_s; });
  figures.cpu_s = over_seeds([](const FreiburgFigures& run) { return run.cpu_s; });
  figures.real_time_factor = over_seeds([](const FreiburgFigures& run) { return run.real_time_factor(); });
  figures.peak_memory_mib = over_seeds([](const FreiburgFigures& run) { return run.peak_memory_mib; });
  return figures;
}

FreiburgBenchmark run_freiburg_benchmark(const std::vector<BenchmarkLog>& logs,
                                         const FreiburgOptions& options, const std::atomic<bool>& stop,
                                         const ProgressObserver& progress) {
  FreiburgBenchmark benchmark = plan(logs, options);
  const std::vector<Task> tasks = tasks_of(benchmark, logs, options);
  double work = 0;
  for (const Task& task : tasks) work += task.work;
  TaskProgress running(tasks.size(), work, progress);
  std::vector<ChildWords> children;
  for (const Task& task : tasks) children.push_back(words_of(task.run, options.program));
  const ChildWorkers workers = options.workers ? options.workers : local_child_workers(options.processes);
  workers(children, {[&] { return stop.load(); }, [&](std::size_t task) { running.show(tasks[task].name); },
                     [&](std::size_t task, const ChildEnd& end) { take(tasks[task], end, running); }});
  if (stop && running.remaining() > 0)
    throw SystemFailure("interrupted with " + std::to_string(running.remaining()) +
                        " runs to go: finished runs are kept in " + (options.output / "runs").string() +
                        "; repeat the command to continue");
  return benchmark;
}

}  // namespace psi_slam
