// SPDX-License-Identifier: BSD-3-Clause
// A benchmark log mapped as psi-slam maps it, and how far its map is from the truth.
#pragma once

#include <functional>
#include <vector>

#include "psi_slam/frame_source.h"
#include "mapping/mapper_options.h"
#include "psi_slam/mapper.h"
#include "psi_slam/pose_graph.h"
#include "evaluation/relations_metric.h"

namespace psi_slam {

struct MappedRun {
  MappingResult result;
  PoseGraph graph;  ///< optimised, with the kinds of the constraints and those that are switched off
};

/// `progress` is called with the share of the log done. Throws UserError as the source does.
MappedRun map_source(FrameSource& source, const MapperOptions& options,
                     const std::function<void(double)>& progress);

/// That are in the finished graph.
std::size_t loops_accepted(const MappingResult& result);

/// Of where the map has the frames.
RelationsMetric error_of(const std::vector<FrameRecord>& frames, const std::vector<Relation>& relations);

}  // namespace psi_slam
