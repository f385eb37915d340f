// SPDX-License-Identifier: BSD-3-Clause
// The folder of a run's results, under fixed names:
//
//     map.*  map_print.png                  the map, in the forms that MapFileOptions names
//     trajectory.tum  trajectory.carmen     the trajectory of all scans, and the corrected log
//     trajectory-1.tum  trajectory-1.carmen where several drives were merged, each one's, and so on; and no
//                                           trajectory.carmen: see write_corrected_log()
//     frames.csv  loops.csv  summary.json  report.html
//
// MappingSession adds graph.g2o, and loops.edits where loops were edited.
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>

#include "psi_slam/mapping_result.h"
#include "exports/map_files.h"
#include "exports/run_summary.h"

namespace psi_slam {

/// A folder that is ready to be written to.
class OutputFolder {
 public:
  /// Makes the folder, with those above it. It must be new or empty, unless `force`: then files of a run's
  /// names will be replaced and others are left alone. Throws UserError when it holds something, is not a
  /// folder, or cannot be made or written to. Call it before the work, so that a mistake is told at once.
  static OutputFolder prepare(const std::filesystem::path& path, bool force);

  const std::filesystem::path& path() const { return path_; }

 private:
  explicit OutputFolder(std::filesystem::path path) : path_(std::move(path)) {}
  std::filesystem::path path_;
};

/// Writes the maps, the trajectories and the tables, each file whole or not at all. `grid` is the map of
/// `result` as draw_grid_map makes it. Throws SystemFailure (a sentence that names the file) when the disk
/// does not take one.
void export_results(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid,
                    const OutputFolder& folder, const MapFileOptions& map_files = {});

/// Writes summary.json and, last of all, report.html: after the rest, so that their times include the writing
/// of it. Throws as export_results.
void export_account(const MappingResult& result, const RunInfo& info, const RunSummary& summary,
                    const mrpt::maps::COccupancyGridMap2D& grid, const OutputFolder& folder);

/// Where each scan was taken in the map, in the log's order.
std::vector<mrpt::math::TPose2D> mapped_poses(const MappingResult& result);

}  // namespace psi_slam
