// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg_benchmark.h"

#include <fstream>
#include <iterator>
#include <mutex>
#include <nlohmann/json.hpp>

#include "child_process.h"
#include "file_checksum.h"
#include "program_identity.h"
#include "psi_slam/base/atomic_file.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/base/worker_pool.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr std::string_view kSpokenBy = "psi-slam-bench: ";  // before every sentence of the program

/// A run with its place in the benchmark.
struct Task {
  FreiburgRun run;
  std::string name;  // "intel-csm-1"
  fs::path file;     // what it came to
  std::string key;   // of all that its figures depend on
  double work = 0;   // in a unit that is proportional to its time
  const FreiburgLog* log = nullptr;
  FreiburgResult* result = nullptr;
};

std::string key_of(const FreiburgRun& run, const FreiburgLog& log, const std::string& program_sha256) {
  return sha256_of_text(log.sha256 + '\n' + log.relations_sha256 + '\n' + program_version() + '\n' +
                        program_sha256 + '\n' + settings_text(settings_of(run)));
}

/// The figures of a run made before, if its file is there and of this key.
std::optional<FreiburgFigures> kept_figures(const Task& task) {
  std::ifstream file(task.file, std::ios::binary);
  if (!file) return std::nullopt;
  const Json json = Json::parse(std::string(std::istreambuf_iterator<char>(file), {}), nullptr, false);
  if (!json.is_object() || json.value("key", Json()) != task.key || !json.contains("figures"))
    return std::nullopt;
  return read_figures(json["figures"].dump());
}

void keep_figures(const Task& task, const FreiburgFigures& figures) {
  const FreiburgLog& log = *task.log;
  const Json json = {{"schema", "psi-slam-freiburg-run"},
                     {"schema_version", 1},
                     {"key", task.key},
                     {"log", log.name},
                     {"log_sha256", log.sha256},
                     {"relations_sha256", log.relations_sha256},
                     {"matcher", task.run.matcher},
                     {"seed", task.run.seed},
                     {"threads", task.run.threads},
                     {"program_version", program_version()},
                     {"commit", program_commit()},
                     {"figures", Json::parse(figures_json(figures))},
                     {"settings", settings_text(settings_of(task.run))}};
  write_text_atomically(task.file, json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
}

ChildProcess process_of(const FreiburgRun& run, const fs::path& program) {
  ChildProcess child;
  child.words = {program.string(), "freiburg-run",
                 "--log",          run.log.string(),
                 "--ini",          run.ini.string(),
                 "--relations",    run.relations.string(),
                 "--matcher",      run.matcher,
                 "--seed",         std::to_string(run.seed),
                 "--threads",      std::to_string(run.threads)};
  return child;
}

/// Runs the process to its end: its figures with what it took, or why there are none.
FreiburgResult result_of(const ChildProcess& child, std::uint64_t seed) {
  FreiburgResult result;
  result.seed = seed;
  result.made = true;
  ChildEnd end;
  try {
    end = run_child(child);
    result.failure = end.failure();
  } catch (const SystemFailure& failure) {
    result.failure = failure.what();
  }
  if (result.failure.compare(0, kSpokenBy.size(), kSpokenBy) == 0) result.failure.erase(0, kSpokenBy.size());
  if (!result.failure.empty()) return result;
  result.figures = read_figures(end.out);
  if (!result.figures) {
    result.failure = "the run printed no figures";
    return result;
  }
  result.figures->wall_s = end.wall_s;
  result.figures->cpu_s = end.cpu_s;
  result.figures->peak_memory_mib = end.peak_memory_mib;
  return result;
}

FreiburgRun run_of(const BenchmarkLog& log, const std::string& matcher, std::uint64_t seed, int threads) {
  return {log.log, log.ini, log.relations.value(), matcher, seed, threads};
}

/// All cells, their runs not made yet.
FreiburgBenchmark plan(const std::vector<BenchmarkLog>& logs, const FreiburgOptions& options) {
  FreiburgBenchmark benchmark;
  for (const BenchmarkLog& log : logs) {
    benchmark.logs.push_back({log.name, sha256_of_file(log.log), sha256_of_file(log.relations.value())});
    for (const std::string& matcher : options.matchers) {
      FreiburgCell cell{log.name, matcher, {}};
      cell.runs.resize(draws_random_numbers(matcher) ? options.seeds : 1);
      for (std::size_t i = 0; i < cell.runs.size(); ++i) cell.runs[i].seed = i + 1;
      benchmark.cells.push_back(std::move(cell));
    }
  }
  return benchmark;
}

/// The runs that are not there yet; the results of the others are filled in.
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
      task.key = key_of(task.run, benchmark.logs[log], program_sha256);
      task.work = static_cast<double>(fs::file_size(logs[log].log));
      task.log = &benchmark.logs[log];
      task.result = &result;
      result.figures = kept_figures(task);
      if (!result.figures) tasks.push_back(std::move(task));
    }
  }
  return tasks;
}

/// Who runs one task after another, and tells how far it is.
class Tasks {
 public:
  Tasks(const std::vector<Task>& tasks, const FreiburgOptions& options, const std::atomic<bool>& stop,
        const std::function<void(const std::string&, double, double)>& progress)
      : tasks_(tasks), options_(options), stop_(stop), progress_(progress) {
    for (const Task& task : tasks) all_ += task.work;
  }

  void run(std::size_t index) {
    if (stop_) return;
    const Task& task = tasks_[index];
    ChildProcess child = process_of(task.run, options_.program);
    child.stop = [&] {
      tell(task.name);
      return stop_.load();
    };
    const FreiburgResult result = result_of(child, task.run.seed);
    if (stop_ && !result.figures) return;
    if (result.figures) keep_figures(task, *result.figures);
    *task.result = result;
    const std::lock_guard lock(mutex_);
    ++ended_;
    done_ += task.work;
  }

  std::size_t ended() const { return ended_; }

 private:
  void tell(const std::string& name) {
    const std::lock_guard lock(mutex_);
    progress_(name + ", " + std::to_string(ended_) + " of " + std::to_string(tasks_.size()) + " runs", done_,
              all_);
  }

  const std::vector<Task>& tasks_;
  const FreiburgOptions& options_;
  const std::atomic<bool>& stop_;
  const std::function<void(const std::string&, double, double)>& progress_;
  double all_ = 0;

  std::mutex mutex_;  // of what follows
  double done_ = 0;
  std::size_t ended_ = 0;
};

}  // namespace

FreiburgBenchmark run_freiburg_benchmark(
    const std::vector<BenchmarkLog>& logs, const FreiburgOptions& options, const std::atomic<bool>& stop,
    const std::function<void(const std::string&, double, double)>& progress) {
  FreiburgBenchmark benchmark = plan(logs, options);
  const std::vector<Task> tasks = tasks_of(benchmark, logs, options);
  Tasks running(tasks, options, stop, progress);
  WorkerPool pool(options.processes);
  pool.run(tasks.size(), [&](std::size_t index) { running.run(index); });
  if (stop && running.ended() < tasks.size())
    throw SystemFailure("interrupted with " + std::to_string(tasks.size() - running.ended()) +
                        " runs to go: the others are kept in " + (options.output / "runs").string() +
                        ", and the same command goes on");
  return benchmark;
}

}  // namespace psi_slam
