// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_benchmark.h"

#include <nlohmann/json.hpp>

#include <atomic>

#include "base/file_checksum.h"
#include "batch/kept_run.h"
#include "common/benchmark_logs.h"
#include "map/exports/mapped_trajectory.h"
#include "map/trajectory/loop_judgement.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// A run to make, with the file and the object for its result.
struct Task {
  FreiburgRun run;
  std::string name;  // "intel-csm-1"
  fs::path file;     // file for the result
  RunKey key;
  double work = 0;  // bytes of the log
  const LogIdentity* log = nullptr;
  FreiburgResult* result = nullptr;
};

/// Stores figures, time and memory of a finished run in `task.result` and `task.file`. After a failed run,
/// stores only the reason, in `task.result`.
void take(const Task& task, const ChildEnd& end) {
  FreiburgResult& result = *task.result;
  result.made = true;
  result.failure = end.failure_without("psi-slam-bench: ");
  if (!result.failure.empty()) return;
  result.figures = read_figures(end.out);
  if (!result.figures) {
    result.failure = "the run printed no figures";
    return;
  }
  set_effort(*result.figures, end);
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
            {"program_version", PSI_SLAM_VERSION},
            {"commit", program_commit()},
            {"figures", Json::parse(figures_json(*result.figures))},
            {"settings", settings_text(settings_of(task.run))}});
}

/// Makes the cells of `benchmark` and fills them with kept results. Returns the runs without kept results.
std::vector<Task> plan(const std::vector<BenchmarkLog>& logs, const FreiburgOptions& options,
                       FreiburgBenchmark& benchmark) {
  const std::string program_sha256 = sha256_of_file(options.program);
  benchmark.logs = identities_of(logs);
  benchmark.cells.reserve(logs.size() * options.matchers.size());  // keeps the tasks' pointers valid
  std::vector<Task> tasks;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    const BenchmarkLog& log = logs[i];
    const LogIdentity& identity = benchmark.logs[i];
    for (const std::string& matcher : options.matchers) {
      FreiburgCell& cell = benchmark.cells.emplace_back(FreiburgCell{log.name, matcher, {}});
      cell.runs.resize(draws_random_numbers(matcher) ? options.seeds.count() : 1);
      for (std::size_t k = 0; k < cell.runs.size(); ++k) {
        FreiburgResult& result = cell.runs[k];
        result.seed = options.seeds.first + k;
        Task task;
        task.run = {log.log, log.ini, log.relations.value(), matcher, result.seed, options.threads};
        task.name = log.name + '-' + matcher + '-' + std::to_string(result.seed);
        task.file = options.output / "runs" / (task.name + ".json");
        const std::string inputs = machine_text() + '\n' + identity.sha256 + '\n' +
                                   identity.relations_sha256 + "\n" PSI_SLAM_VERSION "\n" + program_sha256 +
                                   '\n' + settings_text(settings_of(task.run));
        task.key = {sha256_of_text(inputs), options.processes};
        task.work = static_cast<double>(fs::file_size(log.log));
        task.log = &identity;
        task.result = &result;
        if (const auto kept = kept_run(task.file, task.key); kept && kept->contains("figures"))
          result.figures = read_figures(kept->at("figures").dump());
        if (!result.figures) tasks.push_back(std::move(task));
      }
    }
  }
  return tasks;
}

}  // namespace

const std::vector<std::string>& freiburg_matchers() {
  static const std::vector<std::string> kMatchers{"csm", "csm_ga", "ga", "adaptive", "adaptive_paper"};
  return kMatchers;
}

bool draws_random_numbers(const std::string& matcher) {
  return matcher != "csm";
}

Settings settings_of(const FreiburgRun& run) {
  std::vector<std::string> assignments{"run.seed=" + std::to_string(run.seed),
                                       "run.threads=" + std::to_string(run.threads)};
  if (run.matcher == "adaptive_paper") {
    const std::vector<std::string> paper = paper_switch_settings();
    assignments.insert(assignments.end(), paper.begin(), paper.end());
    assignments.emplace_back("genetic.variant=paper");
  } else {
    assignments.push_back("loop_closure.matcher=" + run.matcher);
  }
  return benchmark_settings(run.ini, assignments);
}

std::string settings_text(const Settings& settings) {
  BoundSettings bound;
  bound.settings = settings;
  std::string text;
  for (const Option* option : bound.table.options_and_constants())
    text += option->name() + " = " + option->text() + '\n';
  return text;
}

FreiburgFigures map_and_evaluate(const FreiburgRun& run) {
  const std::vector<Relation> relations = read_relations(run.relations);
  MappingSession session(run.log, settings_of(run));
  session.run(std::atomic<bool>(false));
  if (session.broken_off()) throw UserError(*session.broken_off());

  const MappingResult& result = session.result();
  FreiburgFigures figures;
  static_cast<RunFigures&>(figures) = evaluate_path(trajectory_of(result.frames), relations);
  figures.loops_accepted = loops_accepted(result);
  const LoopJudgement judgement = judge_loops(result, relations);
  figures.loops_judged = judgement.judged.size();
  figures.loops_false = judgement.false_ones.size();
  figures.loop_recall = judgement.recall();
  return figures;
}

std::string figures_json(const FreiburgFigures& figures) {
  Json json = run_figures_json(figures);
  json.update({{"loops_accepted", figures.loops_accepted},
               {"loops_judged", figures.loops_judged},
               {"loops_false", figures.loops_false},
               {"loop_recall", figures.loop_recall ? Json(*figures.loop_recall) : Json(nullptr)}});
  return json.dump();
}

std::optional<FreiburgFigures> read_figures(const std::string& text) {
  try {
    const Json json = Json::parse(text);
    FreiburgFigures figures{read_run_figures(json),
                            json.at("loops_accepted"),
                            json.at("loops_judged"),
                            json.at("loops_false"),
                            {}};
    if (const Json& recall = json.at("loop_recall"); !recall.is_null())
      figures.loop_recall = recall.get<double>();
    return figures;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

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
  std::vector<double> recalls;
  for (const FreiburgFigures& run : runs)
    if (run.loop_recall) recalls.push_back(*run.loop_recall);
  if (!recalls.empty()) figures.loop_recall = spread_of(recalls);
  figures.wall_s = over_seeds([](const FreiburgFigures& run) { return run.wall_s; });
  figures.cpu_s = over_seeds([](const FreiburgFigures& run) { return run.cpu_s; });
  figures.real_time_factor = over_seeds([](const FreiburgFigures& run) { return run.real_time_factor(); });
  figures.peak_memory_mib = over_seeds([](const FreiburgFigures& run) { return run.peak_memory_mib; });
  return figures;
}

FreiburgBenchmark run_freiburg_benchmark(const std::vector<BenchmarkLog>& logs,
                                         const FreiburgOptions& options, const std::atomic<bool>& stop,
                                         const ProgressObserver& progress) {
  FreiburgBenchmark benchmark;
  const std::vector<Task> tasks = plan(logs, options, benchmark);
  double work = 0;
  for (const Task& task : tasks) work += task.work;
  TaskProgress running(tasks.size(), work, progress);
  std::vector<ChildWords> children;
  for (const Task& task : tasks) {
    const FreiburgRun& run = task.run;
    children.push_back({options.program.string(), "freiburg-run", "--log", run.log.string(), "--ini",
                        run.ini.string(), "--relations", run.relations.string(), "--matcher", run.matcher,
                        "--seed", std::to_string(run.seed), "--threads", std::to_string(run.threads)});
  }
  carry_out(children, options.processes, run_to_end,
            WorkWatch<ChildEnd>{[&] { return stop.load(); },
                                [&](std::size_t task) { running.show(tasks[task].name); },
                                [&](std::size_t task, const ChildEnd& end) {
                                  take(tasks[task], end);
                                  running.end(tasks[task].work);
                                }});
  if (stop && running.remaining() > 0)
    throw SystemFailure("interrupted with " + std::to_string(running.remaining()) +
                        " runs to go: finished runs are kept in " + (options.output / "runs").string() +
                        "; repeat the command to continue");
  return benchmark;
}

}  // namespace psi_slam
