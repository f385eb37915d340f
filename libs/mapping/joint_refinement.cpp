// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/joint_refinement.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "matching/point_grid.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Number of nodes between two reports of progress. The task of a node refines its frame and the frames before
// the next node.
constexpr std::size_t kBatch = 64;
// When the nearest nodes are chosen, a turn by this angle counts like a distance of one metre.
constexpr double kRadiansPerMetre = 1.0;

PointGrid positions(const std::vector<TPose2D>& poses, double cell_m) {
  std::vector<mrpt::math::TPoint2Df> points;
  for (const TPose2D& pose : poses) points.push_back(position(pose));
  return PointGrid(std::move(points), cell_m);
}

/// Poses of the nodes in one round, and the surfaces that their scans saw.
class Round {
 public:
  Round(std::vector<TPose2D> map_T_node, const std::vector<SurfacePoints>& seen,
        const JointRefinementOptions& options)
      : map_T_node_(std::move(map_T_node)),
        seen_(seen),
        options_(options),
        index_(positions(map_T_node_, options.reach_m)) {}

  /// Surfaces seen by the nodes near `node`, except those seen by `node` itself.
  SurfaceMap surfaces_near(std::size_t node) const {
    std::vector<SurfaceMap::Part> parts;
    for (const std::size_t other : references(node)) parts.push_back({&seen_[other], map_T_node_[other]});
    return SurfaceMap(parts);
  }

 private:
  std::vector<std::size_t> references(std::size_t node) const {
    const TPose2D& here = map_T_node_[node];
    std::vector<std::pair<double, std::size_t>> near;
    for (const std::size_t other : index_.within(position(here), static_cast<float>(options_.reach_m))) {
      const TPose2D& there = map_T_node_[other];
      const double turn = std::abs(mrpt::math::wrapToPi(there.phi - here.phi));
      if (other == node || turn > options_.max_turn_rad || seen_[other].points.empty()) continue;
      near.emplace_back(distance_m(here, there) + turn / kRadiansPerMetre, other);
    }
    std::sort(near.begin(), near.end());
    near.resize(std::min(near.size(), options_.references));
    std::vector<std::size_t> chosen;
    for (const auto& [distance, other] : near) chosen.push_back(other);
    return chosen;
  }

  std::vector<TPose2D> map_T_node_;
  const std::vector<SurfacePoints>& seen_;
  const JointRefinementOptions& options_;
  PointGrid index_;
};

std::vector<TPose2D> poses_of(const std::vector<TPose2D>& map_T_frame,
                              const std::vector<std::size_t>& frames) {
  std::vector<TPose2D> poses;
  for (const std::size_t frame : frames) poses.push_back(map_T_frame[frame]);
  return poses;
}

}  // namespace

void refine_jointly(RefinedScans& scans, const JointRefinementOptions& options, WorkerPool& pool,
                    const std::function<bool(double)>& progress) {
  const std::vector<std::size_t>& nodes = scans.node_frames;
  if (options.rounds < 1 || nodes.empty()) return;
  const std::vector<TPose2D> held_at = scans.map_T_frame;
  const auto seen = map_in_parallel<SurfacePoints>(
      pool, nodes.size(), [&](std::size_t node) { return surface_points(scans.points(nodes[node])); });

  for (int done = 0; done < options.rounds; ++done) {
    const Round round(poses_of(scans.map_T_frame, nodes), seen, options);
    std::vector<TPose2D> refined = scans.map_T_frame;
    const auto refine_stretch = [&](std::size_t node) {
      std::optional<SurfaceMap> surfaces;
      const std::size_t end = node + 1 < nodes.size() ? nodes[node + 1] : refined.size();
      for (std::size_t frame = node == 0 ? 0 : nodes[node]; frame < end; ++frame) {
        const SurfacePoints scan = frame == nodes[node] ? seen[node] : surface_points(scans.points(frame));
        if (scan.points.empty()) continue;
        if (!surfaces) surfaces = round.surfaces_near(node);
        refined[frame] =
            align_to_surfaces(*surfaces, scan, scans.map_T_frame[frame], held_at[frame], options.alignment)
                .map_T_robot;
      }
    };
    for (std::size_t begin = 0; begin < nodes.size(); begin += kBatch) {
      const std::size_t count = std::min(kBatch, nodes.size() - begin);
      pool.run(count, [&](std::size_t index) { refine_stretch(begin + index); });
      const std::size_t end = begin + count;
      if (end == nodes.size()) scans.map_T_frame = refined;
      const double share = static_cast<double>(end) / static_cast<double>(nodes.size());
      if (!progress((done + share) / options.rounds)) return;
    }
  }
}

}  // namespace psi_slam
