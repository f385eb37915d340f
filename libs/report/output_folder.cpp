// SPDX-License-Identifier: BSD-3-Clause
#include "report/output_folder.h"

#include <unistd.h>

#include <string>
#include <system_error>
#include <vector>

#include "base/atomic_file.h"
#include "exports/corrected_log.h"
#include "exports/csv_tables.h"
#include "psi_slam/user_error.h"
#include "report/report_html.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

/// Throws UserError if the path or one of its parents is a file.
void check_no_file_in_the_way(const fs::path& path) {
  std::error_code ignored;
  fs::path part;
  for (const fs::path& name : path) {
    part /= name;
    if (fs::exists(part, ignored) && !fs::is_directory(part, ignored))
      throw UserError("cannot write to the folder " + path.string() + ": " + part.string() +
                      " is a file, not a folder. Name another folder");
  }
}

/// Writes the corrected log of a single log. For several merged logs, whose times may overlap, writes a
/// trajectory and a corrected log of each. Deletes files of these kinds that older results left.
void write_runs(const fs::path& folder, const MappingResult& result) {
  const auto file = [&](std::size_t run, const char* kind) {
    return folder / ("trajectory-" + std::to_string(run) + kind);
  };
  const fs::path whole_log = folder / "trajectory.carmen";
  const Trajectory whole = trajectory_of(result.frames);
  const std::vector<mrpt::math::TPose2D> poses = mapped_poses(result);
  std::vector<FrameSpan> runs = logs_of(result);
  std::error_code ignored;
  if (runs.size() == 1) {
    write_corrected_log(whole_log, result.log, poses);
    runs.clear();
  } else {
    fs::remove(whole_log, ignored);
  }
  for (std::size_t i = 0; i < runs.size(); ++i) {
    write_tum(file(i + 1, ".tum"), Trajectory(whole.begin() + static_cast<std::ptrdiff_t>(runs[i].begin),
                                              whole.begin() + static_cast<std::ptrdiff_t>(runs[i].end)));
    write_corrected_log(file(i + 1, ".carmen"), result.log, poses, runs[i]);
  }
  for (const char* kind : {".tum", ".carmen"})
    for (std::size_t older = runs.size() + 1; fs::remove(file(older, kind), ignored);) ++older;
}

}  // namespace

void OutputFolder::check(const fs::path& path, bool force) {
  if (path.empty())
    throw UserError("the name of the output folder is empty, expected a path. Name a folder for the results");
  check_no_file_in_the_way(path);
  std::error_code error;
  if (!fs::is_directory(path, error)) return;
  remove_leftovers(path);
  const bool empty = fs::is_empty(path, error);
  if (error) throw UserError("cannot read the output folder " + path.string() + ": " + error.message());
  if (!empty && !force)
    throw UserError("the output folder " + path.string() +
                    " is not empty. Name a new folder, or replace the results in it with --force");
  if (::access(path.c_str(), W_OK | X_OK) != 0)
    throw UserError("cannot write to the output folder " + path.string() +
                    ": no permission. Name another folder");
}

OutputFolder OutputFolder::prepare(const fs::path& path, bool force) {
  check(path, force);
  std::error_code error;
  fs::create_directories(path, error);
  if (error && !fs::is_directory(path))
    throw UserError("cannot create the output folder " + path.string() + ": " + error.message());
  check(path, force);
  return OutputFolder(path);
}

void export_results(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid,
                    const OutputFolder& folder, const std::vector<MapEdit>& edits,
                    const MapFileOptions& map_files) {
  const auto file = [&](const char* name) { return folder.path() / name; };
  write_tum(file("trajectory.tum"), trajectory_of(result.frames));
  write_runs(folder.path(), result);
  write_text_atomically(file("frames.csv"), frames_csv(result.frames));
  write_text_atomically(file("trajectory.csv"), trajectory_csv(result));
  write_text_atomically(file("loops.csv"), loops_csv(result.loops));
  write_map_files(folder.path(), result, grid, edits, map_files);
}

void export_account(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                    const mrpt::maps::COccupancyGridMap2D& grid, const OutputFolder& folder) {
  write_text_atomically(folder.path() / "summary.json", summary_json(result, info, summary));
  write_text_atomically(folder.path() / "report.html", report_html(result, info, summary, grid));
}

}  // namespace psi_slam
