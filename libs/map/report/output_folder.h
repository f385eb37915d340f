// SPDX-License-Identifier: BSD-3-Clause
// The folder with the results of a run, under fixed names:
//
//     map.*                                 the map, in the formats chosen by MapFileOptions
//     trajectory.tum                        the robot's path
//     trajectory.csv                        the robot's path with the covariance of each pose
//     trajectory.carmen                     the corrected log of a single run
//     trajectory-1.tum  trajectory-1.carmen path and corrected log of each run, if several were merged
//     graph.g2o                             the pose graph
//     frames.csv  loops.csv  summary.json  report.html
//
// MappingSession adds loops.edits if loops were edited, and the files of zones.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "base/descriptor.h"
#include "map/exports/map_files.h"
#include "map/exports/mapped_trajectory.h"
#include "map/exports/run_summary.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// A folder that exists and can be written to.
class OutputFolder {
 public:
  /// Creates the folder and its parents. An existing folder must be empty, apart from temporary files of a
  /// killed program. If `force` is true, it need not be empty: the files of a run are replaced and all others
  /// kept. Throws UserError if the folder is not empty, is a file, or cannot be created or written to, or if
  /// any process has another OutputFolder of this path. Call it before mapping, so that the user
  /// sees the error at once. `force_text` tells the user how to give `force`.
  static OutputFolder prepare(const std::filesystem::path& path, bool force,
                              const std::string& force_text = "--force");

  /// Throws as prepare() does, but creates no folder. Call it before work that takes long.
  static void check(const std::filesystem::path& path, bool force, const std::string& force_text = "--force");

  /// Replaces the results of an earlier run. Calls `write` with a temporary folder for all files of this run.
  /// Moves them here when all are complete. If one cannot be written, the earlier results stay whole.
  /// Then deletes earlier results that this run does not have, since they would show an older map. Throws
  /// SystemFailure naming the file that cannot be written.
  void replace_results(const std::function<void(const OutputFolder& temporary)>& write) const;

  /// Returns whether results may have a file of this name.
  static bool is_result(const std::string& name);

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit OutputFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
  /// Locks the folder for this process, until the last copy of this object is destroyed.
  std::shared_ptr<const Descriptor> lock_;
};

/// Returns tasks that write the files for which no grid map is needed, each file atomically: trajectories,
/// the pose graph, tables, and map.simplemap.gz if `map_files` selects it. A task throws SystemFailure naming
/// the file that cannot be written. `log` holds the scans for the corrected log: those of `result`, or with
/// the ranges of superseded scans. Both must outlive the tasks.
Tasks path_file_tasks(const MappingResult& result, const std::vector<Frame>& log, const OutputFolder& folder,
                      const MapFileOptions& map_files);

/// Writes summary.json and report.html. Call it after all other files are written, so that the times in both
/// files include the export. Throws SystemFailure naming the file that cannot be written.
void export_account(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                    const mrpt::maps::COccupancyGridMap2D& grid, const OutputFolder& folder);

}  // namespace psi_slam
