// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baselines.h"

#include <mrpt/config/CConfigFileMemory.h>
#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

#include "base/atomic_file.h"
#include "base/file_checksum.h"
#include "base/worker_pool.h"
#include "batch/child_process.h"
#include "batch/kept_run.h"
#include "common/bench_report.h"
#include "freiburg/freiburg_benchmark.h"
#include "logs/frames/pose_operations.h"
#include "logs/observations/mrpt_objects.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kSection = "MappingApplication";
constexpr double kVersionLimit_s = 30;

std::optional<fs::path> find_program(const std::string& name, const std::string& search_path) {
  std::istringstream folders(search_path);
  for (std::string folder; std::getline(folders, folder, ':');) {
    const fs::path program = fs::path(folder.empty() ? "." : folder) / name;
    std::error_code failed;
    if (fs::is_regular_file(program, failed) && ::access(program.c_str(), X_OK) == 0)
      return fs::canonical(program);
  }
  return std::nullopt;
}

/// Version that the program prints when it starts. The program has no option that only prints the version.
std::string version_of(const fs::path& program) {
  constexpr std::string_view kBefore = "MRPT C++ Library: ";
  const ChildEnd end = run_child({{program.string()}, kVersionLimit_s});
  const std::string words = end.out + end.err;
  const std::size_t begin = words.find(kBefore);
  if (begin == std::string::npos) return "unknown version";
  const std::size_t first = begin + kBefore.size();
  return words.substr(first, words.find_first_of("\r\n", first) - first);
}

/// Reason of a failure: MRPT's programs print it in a line that starts with "Message:".
std::string failure_of(const ChildEnd& end) {
  constexpr std::string_view kBefore = "Message:";
  const std::size_t begin = end.err.find(kBefore);
  if (begin == std::string::npos) return end.failure();
  const std::size_t first = end.err.find_first_not_of(' ', begin + kBefore.size());
  return first == std::string::npos ? end.failure()
                                    : end.err.substr(first, end.err.find('\n', first) - first);
}

constexpr const char* kUnfinished = "not_finished_in_s";

struct BaselineTask {
  BaselineRun run;
  fs::path file;
  RunKey key;
  double work = 0;
  BaselineResult* result = nullptr;
};

/// Checksum of everything that the result depends on, including the psi-slam settings for reading the log.
/// Leaves out the checksum of this program, because a new build need not repeat the runs.
std::string key_of(const BaselineRun& run) {
  return sha256_of_text(machine_text() + '\n' + sha256_of_file(run.log.log) + '\n' +
                        sha256_of_file(run.log.relations.value()) + "\n" PSI_SLAM_VERSION "\n" +
                        settings_text(benchmark_settings(run.log.ini)) + run.baseline.version + '\n' +
                        run.baseline.sha256 + '\n' + baseline_settings(run.baseline, "output"));
}

/// Reads the result of an earlier run into `task.result`. Returns false if the run must be made.
bool read_kept(const BaselineTask& task) {
  const std::optional<Json> kept = kept_run(task.file, task.key);
  if (!kept) return false;
  BaselineResult& result = *task.result;
  try {
    if (kept->contains("figures"))
      result.figures = read_run_figures(kept->at("figures"));
    else if (const auto limit_s = kept->at(kUnfinished).get<double>(); limit_s >= task.run.time_limit_s)
      result.not_finished_in_s = limit_s;
  } catch (const Json::exception&) {  // the file is damaged: repeat the run
  }
  return result.figures || result.not_finished_in_s;
}

/// Writes a result to its file. Does not write a failure, so that the next command repeats the run.
void keep(const BaselineTask& task, const BaselineResult& result) {
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

/// Returns the runs without kept results. Fills `results` with the kept results of all other runs.
std::vector<BaselineTask> tasks_of(const std::vector<BaselineProgram>& baselines,
                                   const std::vector<BenchmarkLog>& logs, const BaselineOptions& options,
                                   std::vector<BaselineResult>& results) {
  std::vector<BaselineTask> tasks;
  results.resize(logs.size() * baselines.size());
  auto result = results.begin();
  for (const BenchmarkLog& log : logs)
    for (const BaselineProgram& baseline : baselines) {
      const std::string name = log.name + '-' + baseline.kind.name;
      BaselineTask task;
      task.run = {baseline, log, options.output / "baselines" / name, options.time_limit_s};
      task.file = options.output / "runs" / (name + ".json");
      task.key = {key_of(task.run), options.processes};
      task.work = static_cast<double>(fs::file_size(log.log));
      task.result = &*result++;
      task.result->log = log.name;
      task.result->baseline = baseline.kind.name;
      if (!read_kept(task)) tasks.push_back(std::move(task));
    }
  return tasks;
}

}  // namespace

const std::vector<BaselineKind>& baseline_kinds() {
  constexpr std::size_t kPlaneYaw = 3;  // columns: step, x, y, yaw
  constexpr std::size_t kSpaceYaw = 4;  // columns: step, x, y, z, yaw
  static const std::vector<BaselineKind> kKinds{
      {"icp-slam",
       "icp-slam/icp-slam_demo_classic.ini",
       {{"SHOW_PROGRESS_3D_REAL_TIME", "0"}, {"SAVE_3D_SCENE", "0"}},
       "Tiny changes of the input decide where it loses track, so other runs give other figures. Started "
       "one, two or three scans later, it reaches 0.68, 0.42 and 1.96 m on MIT CSAIL.",
       kPlaneYaw},
      {"rbpf-slam",
       "rbpf-slam/gridmapping_RBPF_grid_ICPbased_malaga.ini",
       {{"SHOW_PROGRESS_IN_WINDOW", "0"},
        {"SAVE_3D_SCENE", "0"},
        {"SAVE_MAP_IMAGES", "0"},
        {"RANDOM_SEED", "1"}},
       "Its path consists of its estimates at the time of each scan. It is not the path of the best "
       "particle.",
       kSpaceYaw}};
  return kKinds;
}

FoundBaselines find_baselines(const std::string& search_path) {
  FoundBaselines found;
  for (const BaselineKind& kind : baseline_kinds()) {
    const auto program = find_program(kind.name, search_path);
    if (!program) {
      found.missing.push_back(kind.name + " is not on PATH");
      continue;
    }
    const fs::path config = program->parent_path().parent_path() / "share/mrpt/config_files" / kind.config;
    if (!fs::exists(config)) {
      found.missing.push_back(program->string() + " has no settings: expected " + config.string());
      continue;
    }
    found.programs.push_back({kind, *program, config, version_of(*program), sha256_of_file(*program)});
  }
  return found;
}

std::string baseline_settings(const BaselineProgram& baseline, const fs::path& output) {
  std::ifstream file(baseline.config, std::ios::binary);
  const std::string shipped(std::istreambuf_iterator<char>(file), {});
  if (!file) throw UserError(baseline.config.string() + " cannot be read: check its permissions");
  mrpt::config::CConfigFileMemory settings(shipped);
  for (const auto& [key, value] : baseline.kind.changes) settings.write(kSection, key, value);
  settings.write(kSection, "logOutput_dir", output.string());
  return settings.getContent();
}

std::string changes_text(const BaselineKind& kind) {
  std::string text;
  for (const auto& [key, value] : kind.changes) text += (text.empty() ? "" : ", ") + key + " = " + value;
  return text;
}

std::vector<TimeUs> write_baseline_log(FrameSource& source, const std::filesystem::path& path,
                                       const std::function<bool()>& stop) {
  std::vector<TimeUs> times;
  write_atomically(path, [&](const std::filesystem::path& temporary) {
    mrpt::io::CFileOutputStream file(temporary.string());
    auto archive = mrpt::serialization::archiveFrom(file);
    mrpt::math::TPose2D odom_T_last;
    while (const std::optional<Frame> frame = source.next()) {
      if (stop()) throw SystemFailure("interrupted");
      const mrpt::math::TPose2D motion = times.empty() || !frame->has_odometry
                                             ? mrpt::math::TPose2D()
                                             : between(odom_T_last, frame->odom_T_robot);
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
  const fs::path folder = fs::absolute(run.folder);
  const fs::path settings = folder / "settings.ini";
  const fs::path output = folder / "output";
  std::error_code failed;
  fs::remove_all(output, failed);
  if (failed) throw SystemFailure("cannot remove " + output.string() + ": " + failed.message());
  fs::create_directories(folder, failed);
  if (failed) throw SystemFailure("cannot create the folder " + folder.string() + ": " + failed.message());
  const ScratchFile log(folder / "log.rawlog");
  try {
    const auto source = open_log(run.log.log, log_options(benchmark_settings(run.log.ini)));
    const std::vector<TimeUs> times = write_baseline_log(*source, log.path, stop);
    write_text_atomically(settings, baseline_settings(run.baseline, output));
    const ChildEnd end = run_child(
        {{run.baseline.program.string(), settings.string(), log.path.string()}, run.time_limit_s, stop});
    if (end.over_time) {
      result.not_finished_in_s = run.time_limit_s;
    } else if (!end.failure().empty()) {
      result.failure = failure_of(end);
    } else {
      const Trajectory path =
          read_baseline_path(output / "log_estimated_path.txt", run.baseline.kind.yaw_column, times);
      result.figures = evaluate_path(path, read_relations(run.log.relations.value()));
      set_effort(*result.figures, end);
    }
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
  const std::vector<BaselineTask> tasks = tasks_of(baselines, logs, options, results);
  double work = 0;
  for (const BaselineTask& task : tasks) work += task.work;
  TaskProgress progress(tasks.size(), work, observer);
  WorkerPool pool(options.processes);
  pool.run(tasks.size(), [&](std::size_t index) {
    if (stop) return;
    const BaselineTask& task = tasks[index];
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
