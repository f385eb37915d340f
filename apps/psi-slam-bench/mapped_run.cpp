// SPDX-License-Identifier: BSD-3-Clause
#include "mapped_run.h"

#include <utility>

namespace psi_slam {

MappedRun map_source(FrameSource& source, const MapperOptions& options,
                     const std::function<void(double)>& progress) {
  Mapper mapper(options);
  while (std::optional<Frame> frame = source.next()) {
    mapper.add(std::move(*frame));
    progress(source.progress());
  }
  MappedRun run;
  run.result = mapper.finish();
  run.graph = mapper.graph();
  return run;
}

RelationsMetric error_of(const std::vector<FrameRecord>& frames, const std::vector<Relation>& relations) {
  Trajectory trajectory;
  for (const FrameRecord& frame : frames) trajectory.push_back({frame.time_us, frame.map_T_robot});
  return evaluate_relations(std::move(trajectory), relations);
}

}  // namespace psi_slam
