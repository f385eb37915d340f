// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/baseline_run.h"

#include <mrpt/io/CFileOutputStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/serialization/CArchive.h>

#include <fstream>
#include <sstream>

#include "base/atomic_file.h"
#include "batch/child_process.h"
#include "config/apply_settings.h"
#include "observations/range_observation.h"
#include "observations/robot_action.h"
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

}  // namespace psi_slam
