// SPDX-License-Identifier: BSD-3-Clause
// Maps a log and measures the processor time of each scan.
#pragma once

#include <vector>

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

}  // namespace psi_slam
