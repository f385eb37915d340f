// SPDX-License-Identifier: BSD-3-Clause
// Maps a log and measures the processor time of each scan.
#pragma once

#include <vector>

#include "batch/run_figures.h"
#include "mapping/mapper_options.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/mapper.h"

namespace psi_slam {

struct MeasuredMap {
  MappingResult result;
  std::vector<double> add_ms;  ///< processor time of Mapper::add for each frame
  double wall_s = 0;
  double cpu_s = 0;
};

/// Maps all frames in this thread. Passes on exceptions of the source.
MeasuredMap map_measured(FrameSource& source, const MapperOptions& options);

/// Errors of `path`, a path of the map, against the true relations, with the times of the map. The memory
/// stays 0. Throws UserError as evaluate_relations() does.
RunFigures figures_of(const MeasuredMap& map, const Trajectory& path, const std::vector<Relation>& relations);

}  // namespace psi_slam
