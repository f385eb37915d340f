// SPDX-License-Identifier: BSD-3-Clause
#include "common/measured_map.h"

#include <chrono>
#include <ctime>
#include <optional>
#include <utility>

namespace psi_slam {
namespace {

/// Processor time of this process, in seconds.
double cpu_s() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

}  // namespace

MeasuredMap map_measured(FrameSource& source, const MapperOptions& options) {
  MeasuredMap map;
  const auto begin = std::chrono::steady_clock::now();
  const double cpu_begin_s = cpu_s();
  Mapper mapper(options);
  while (std::optional<Frame> frame = source.next()) {
    const double before_s = cpu_s();
    mapper.add(*std::move(frame));
    map.add_ms.push_back(1e3 * (cpu_s() - before_s));
  }
  map.result = mapper.finish();
  map.cpu_s = cpu_s() - cpu_begin_s;
  map.wall_s = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return map;
}

RunFigures figures_of(const MeasuredMap& map, const Trajectory& path,
                      const std::vector<Relation>& relations) {
  RunFigures figures = evaluate_path(path, relations);
  figures.scans = map.result.frames.size();
  figures.wall_s = map.wall_s;
  figures.cpu_s = map.cpu_s;
  return figures;
}

}  // namespace psi_slam
