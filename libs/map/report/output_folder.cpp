// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/output_folder.h"

#include <fcntl.h>
#include <unistd.h>

#include <regex>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "base/atomic_file.h"
#include "base/atomic_folder.h"
#include "base/file_lock.h"
#include "base/partial_files.h"
#include "map/exports/corrected_log.h"
#include "map/exports/csv_tables.h"
#include "map/report/report_html.h"
#include "map/trajectory/trajectory_file.h"
#include "pose_graph/g2o_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// Throws UserError if the path or one of its parents is a file.
void check_no_file_in_the_way(const fs::path& path) {
  std::error_code ignored;
  fs::path part;
  for (const fs::path& name : path) {
    part /= name;
    if (fs::is_symlink(part, ignored) && !fs::exists(part, ignored))
      throw UserError("cannot write to the folder " + path.string() + ": " + part.string() +
                      " is a link that leads nowhere. Name another folder");
    if (fs::exists(part, ignored) && !fs::is_directory(part, ignored))
      throw UserError("cannot write to the folder " + path.string() + ": " + part.string() +
                      " is a file, not a folder. Name another folder");
  }
}

/// Returns whether a folder is empty, except for temporary files.
bool holds_only_leftovers(const fs::path& folder, std::error_code& error) {
  for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
    if (!is_partial_name(entry->path().filename().string())) return false;
  return true;
}

/// Locks a folder. Throws UserError if another OutputFolder has locked it. Some file systems know no locks.
std::shared_ptr<const Descriptor> lock_of(const fs::path& path) {
  auto folder = std::make_shared<Descriptor>(::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC));
  if (folder->is_open() && !try_lock_file(*folder))
    throw UserError("another run is writing to the output folder " + path.string() +
                    ". Wait until it ends, or name another folder");
  return folder;
}

/// Writes the corrected log of a single log. For several merged logs, whose times may overlap, writes a
/// trajectory and a corrected log of each.
void write_runs(const fs::path& folder, const MappingResult& result, const std::vector<Frame>& log) {
  const auto file = [&](std::size_t run, const char* kind) {
    return folder / ("trajectory-" + std::to_string(run) + kind);
  };
  const Trajectory whole = trajectory_of(result.frames);
  const std::vector<mrpt::math::TPose2D> poses = mapped_poses(result);
  const std::vector<FrameSpan> runs = logs_of(result);
  if (runs.size() == 1) return write_corrected_log(folder / "trajectory.carmen", log, poses);
  for (std::size_t i = 0; i < runs.size(); ++i) {
    write_tum(file(i + 1, ".tum"), Trajectory(whole.begin() + static_cast<std::ptrdiff_t>(runs[i].begin),
                                              whole.begin() + static_cast<std::ptrdiff_t>(runs[i].end)));
    write_corrected_log(file(i + 1, ".carmen"), log, poses, runs[i]);
  }
}

/// Returns whether some run writes a file of this name. Another run leaves it out if its settings, its edits
/// or the number of its logs differ.
bool is_optional_result(const std::string& name) {
  static const std::regex kNames(
      "map\\.(png|yaml|pgm|gridmap\\.gz|simplemap\\.gz|svg|dxf|tif|gpkg)|map_print\\.png|"
      "trajectory(-[1-9][0-9]*)?\\.carmen|trajectory-[1-9][0-9]*\\.tum|loops\\.edits|"
      "(keepout|speed)_mask\\.(yaml|pgm)|zones\\.txt");
  return std::regex_match(name, kNames);
}

}  // namespace

void OutputFolder::check(const fs::path& path, bool force, const std::string& force_text) {
  if (path.empty())
    throw UserError("the name of the output folder is empty, expected a path. Name a folder for the results");
  check_no_file_in_the_way(path);
  std::error_code error;
  if (!fs::is_directory(path, error)) return;
  remove_leftovers(path);
  const bool empty = holds_only_leftovers(path, error);
  if (error) throw UserError("cannot read the output folder " + path.string() + ": " + error.message());
  if (!empty && !force)
    throw UserError("the output folder " + path.string() +
                    " is not empty. Name a new folder, or replace the results in it with " + force_text);
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    throw UserError("cannot write to the output folder " + path.string() +
                    ": no permission. Name another folder");
}

OutputFolder OutputFolder::prepare(const fs::path& path, bool force, const std::string& force_text) {
  check(path, force, force_text);
  std::error_code error;
  fs::create_directories(path, error);
  if (std::error_code ignored; error && !fs::is_directory(path, ignored))
    throw UserError("cannot create the output folder " + path.string() + ": " + error.message());
  OutputFolder folder(path);
  folder.lock_ = lock_of(path);
  check(path, force, force_text);
  return folder;
}

bool OutputFolder::is_result(const std::string& name) {
  static const std::set<std::string> kRequired{"trajectory.tum", "trajectory.csv", "graph.g2o",  "frames.csv",
                                               "loops.csv",      "summary.json",   "report.html"};
  return kRequired.count(name) > 0 || is_optional_result(name);
}

void OutputFolder::replace_results(const std::function<void(const OutputFolder&)>& write) const {
  write_files_atomically(
      path_, [&](const fs::path& temporary) { write(OutputFolder(temporary)); }, is_optional_result);
}

Tasks path_file_tasks(const MappingResult& result, const std::vector<Frame>& log, const OutputFolder& folder,
                      const MapFileOptions& map_files) {
  const auto file = [&](const char* name) { return folder.path() / name; };
  Tasks tasks;
  tasks.emplace_back([&result, &log, path = folder.path()] { write_runs(path, result, log); });
  tasks.emplace_back([&result, path = file("graph.g2o")] { write_g2o(result.graph, path); });
  tasks.emplace_back(
      [&result, path = file("loops.csv")] { write_text_atomically(path, loops_csv(result.loops)); });
  tasks.emplace_back(
      [&result, path = file("frames.csv")] { write_text_atomically(path, frames_csv(result.frames)); });
  tasks.emplace_back(
      [&result, path = file("trajectory.csv")] { write_text_atomically(path, trajectory_csv(result)); });
  tasks.emplace_back(
      [&result, path = file("trajectory.tum")] { write_tum(path, trajectory_of(result.frames)); });
  if (map_files.mrpt)
    tasks.emplace_back(
        [&result, path = file("map.simplemap.gz")] { write_mrpt_map(path, simple_map(result)); });
  return tasks;
}

void export_account(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                    const mrpt::maps::COccupancyGridMap2D& grid, const OutputFolder& folder) {
  write_text_atomically(folder.path() / "summary.json", summary_json(result, info, summary));
  write_text_atomically(folder.path() / "report.html", report_html(result, info, summary, grid));
}

}  // namespace psi_slam
