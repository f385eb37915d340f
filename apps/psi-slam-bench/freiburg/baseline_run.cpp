// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baseline_run.h"

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/atomic_file.h"
#include "base/file_checksum.h"
#include "base/worker_pool.h"
#include "batch/child_process.h"
#include "batch/kept_run.h"
#include "common/bench_report.h"
#include "config/settings_text.h"
#include "freiburg/freiburg_run.h"
#include "observations/mrpt_objects.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPathFile = "log_estimated_path.txt";

/// Reason of a failure: MRPT's programs print it in a line that starts with "Message:".
std::string failure_of(const ChildEnd& end) {
  constexpr std::string_view kBefore = "Message:";
  const std::size_t begin = end.err.find(kBefore);
  if (begin == std::string::npos) return end.failure();
  const std::size_t first = end.err.find_first_not_of(' ', begin + kBefore.size());
  return first == std::string::npos ? end.failure()
                                    : end.err.substr(first, end.err.find('\n', first) - first);
}

/// The files of a run. The destructor deletes the log, which is large.
class BaselineFiles {
 public:
  explicit BaselineFiles(const fs::path& folder)
      : log(folder / "log.rawlog"), settings(folder / "settings.ini"), output(folder / "output") {
    std::error_code failed;
    fs::remove_all(output, failed);
    if (failed) throw SystemFailure("cannot remove " + output.string() + ": " + failed.message());
    fs::create_directories(folder, failed);
    if (failed) throw SystemFailure("cannot create the folder " + folder.string() + ": " + failed.message());
  }
  ~BaselineFiles() {
    std::error_code ignored;
    fs::remove(log, ignored);
  }
  BaselineFiles(const BaselineFiles&) = delete;
  BaselineFiles& operator=(const BaselineFiles&) = delete;

  const fs::path log;
  const fs::path settings;
  const fs::path output;
};

RunFigures figures_of(const BaselineRun& run, const BaselineFiles& files, const ChildEnd& end,
                      const std::vector<TimeUs>& times) {
  const Trajectory path = read_baseline_path(files.output / kPathFile, run.baseline.kind.yaw_column, times);
  RunFigures figures = evaluate_path(path, read_relations(run.log.relations.value()));
  set_effort(figures, end);
  return figures;
}

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

std::vector<TimeUs> write_baseline_log(FrameSource& source, const std::filesystem::path& path,
                                       const std::function<bool()>& stop) {
  std::vector<TimeUs> times;
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    mrpt::io::CFileOutputStream file(temporary.string());
    auto archive = mrpt::serialization::archiveFrom(file);
    mrpt::math::TPose2D odom_T_last;
    while (const std::optional<Frame> frame = source.next()) {
      if (stop()) throw SystemFailure("interrupted");
      const mrpt::math::TPose2D motion =
          times.empty() || !frame->has_odometry ? mrpt::math::TPose2D() : frame->odom_T_robot - odom_T_last;
      odom_T_last = frame->odom_T_robot;
      mrpt::obs::CSensoryFrame observations;
      for (const auto& observation : range_observations(*frame)) observations.insert(observation);
      archive << robot_action(motion, frame->time_us) << observations;
      times.push_back(frame->time_us);
    }
  });
  return times;
}

Trajectory read_baseline_path(const fs::path& file, std::size_t yaw_column,
                              const std::vector<TimeUs>& times) {
  std::ifstream lines(file);
  if (!lines) throw UserError("the program wrote no path: expected " + file.string());
  Trajectory path;
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::vector<double> values;
    for (double value = 0; words >> value;) values.push_back(value);
    const std::string place = file.string() + ':' + std::to_string(path.size() + 1) + ": ";
    if (values.size() <= yaw_column || !words.eof())
      throw UserError(place + "expected the columns step, x, y up to the yaw");
    if (path.size() == times.size() || values[0] != static_cast<double>(path.size()))
      throw UserError(place + "expected the poses of steps 0 to " + std::to_string(times.size() - 1));
    path.push_back({times[path.size()], {values[1], values[2], values[yaw_column]}});
  }
  if (path.size() != times.size())
    throw UserError("the program wrote " + std::to_string(path.size()) + " poses for " +
                    std::to_string(times.size()) + " scans");
  return path;
}

BaselineResult run_baseline(const BaselineRun& run, const std::function<bool()>& stop) {
  BaselineResult result;
  result.log = run.log.name;
  result.baseline = run.baseline.kind.name;
  result.made = true;
  const BaselineFiles files(fs::absolute(run.folder));
  try {
    const auto source = open_log(run.log.log, log_options(benchmark_settings(run.log.ini)));
    const std::vector<TimeUs> times = write_baseline_log(*source, files.log, stop);
    write_text_atomically(files.settings, baseline_settings(run.baseline, files.output));
    ChildProcess child;
    child.words = {run.baseline.program.string(), files.settings.string(), files.log.string()};
    child.time_limit_s = run.time_limit_s;
    child.stop = stop;
    const ChildEnd end = run_child(child);
    if (end.over_time) result.not_finished_in_s = run.time_limit_s;
    if (!end.over_time) result.failure = end.failure().empty() ? "" : failure_of(end);
    if (end.failure().empty()) result.figures = figures_of(run, files, end, times);
  } catch (const UserError& error) {
    result.failure = error.what();
  } catch (const SystemFailure& failure) {
    result.failure = failure.what();
  }
  return result;
}

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
