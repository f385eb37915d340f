// SPDX-License-Identifier: BSD-3-Clause
#include "common/mapped_run.h"

#include <algorithm>
#include <utility>

#include "exports/mapped_trajectory.h"

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

std::size_t loops_accepted(const MappingResult& result) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(),
                    [](const LoopRecord& loop) { return loop.verdict == LoopVerdict::kAccepted; }));
}

RelationsMetric error_of(const std::vector<FrameRecord>& frames, const std::vector<Relation>& relations) {
  return evaluate_relations(trajectory_of(frames), relations);
}

}  // namespace psi_slam
