// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/open_directions.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "logs/frames/pose_operations.h"
#include "map/verdict/map_views.h"
#include "map/verdict/scan_comparison.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

/// Motion from one view to the next along the direction that the next view leaves open; empty if it has none.
std::optional<double> open_motion_m(const MapView& from, const MapView& to) {
  if (!to.open_direction) return std::nullopt;
  const TPose2D step = between(to.map_T_robot, from.map_T_robot);
  return std::abs(step.x * to.open_direction->x + step.y * to.open_direction->y);
}

}  // namespace

std::optional<TPoint2D> open_direction(const SurfacePoints& surfaces) {
  if (surfaces.normals.empty()) return std::nullopt;
  Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
  for (const mrpt::math::TPoint2Df& one : surfaces.normals) {
    const Eigen::Vector2d normal(static_cast<double>(one.x), static_cast<double>(one.y));
    information += normal * normal.transpose();
  }
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(information);
  if (solver.eigenvalues()(0) >= kPriorPoints) return std::nullopt;
  return TPoint2D(solver.eigenvectors()(0, 0), solver.eigenvectors()(1, 0));
}

std::vector<OpenStretch> open_stretches(const MappingResult& result, const std::vector<MapView>& views,
                                        double least_length_m) {
  std::vector<OpenStretch> stretches;
  std::optional<std::size_t> last;  // view of the last stretch
  for (std::size_t view = 1; view < views.size(); ++view) {
    const MapView& before = views[view - 1];
    if (before.run != views[view].run) continue;
    const std::optional<double> motion_m = open_motion_m(before, views[view]);
    if (!motion_m) continue;
    if (!last || *last + kLargestStep < view || views[*last].run != views[view].run)
      stretches.push_back({before.frame + 1, 0, 0, {}, true});
    last = view;
    OpenStretch& stretch = stretches.back();
    stretch.last_frame = views[view].frame;
    stretch.length_m += *motion_m;
  }
  stretches.erase(std::remove_if(stretches.begin(), stretches.end(),
                                 [&](const OpenStretch& one) { return one.length_m < least_length_m; }),
                  stretches.end());
  for (OpenStretch& stretch : stretches) {
    const TPose2D& middle = result.frames[(stretch.first_frame + stretch.last_frame) / 2].map_T_robot;
    stretch.at = {middle.x, middle.y};
    for (std::size_t frame = stretch.first_frame; frame <= stretch.last_frame; ++frame)
      stretch.has_odometry = stretch.has_odometry && result.log[frame].has_odometry;
  }
  return stretches;
}

}  // namespace psi_slam
