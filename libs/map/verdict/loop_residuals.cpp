// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/loop_residuals.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/information_matrix.h"

namespace psi_slam {
namespace {

// Standard deviations that are added to those of the match. They cover the refinement of single poses and
// errors within a local map.
constexpr double kModel_m = 0.05;
constexpr double kModel_rad = 0.01;

}  // namespace

std::vector<LoopResidual> loop_residuals(const MappingResult& result) {
  std::vector<LoopResidual> residuals;
  for (std::size_t i = 0; i < result.loops.size(); ++i) {
    const LoopRecord& loop = result.loops[i];
    if (loop.state != LoopState::kAccepted) continue;
    const auto pose = [&](std::size_t node) { return result.frames[result.node_frames[node]].map_T_robot; };
    const mrpt::math::TPose2D mapped = between(pose(loop.reference), pose(loop.node));
    const mrpt::math::TPose2D& matched = loop.reference_T_node;
    const Eigen::Vector3d difference(mapped.x - matched.x, mapped.y - matched.y,
                                     mrpt::math::wrapToPi(mapped.phi - matched.phi));
    Eigen::Matrix3d covariance = in_turned_axes(loop.covariance, matched.phi - loop.anchor_T_node.phi);
    covariance.diagonal() +=
        Eigen::Vector3d(kModel_m * kModel_m, kModel_m * kModel_m, kModel_rad * kModel_rad);
    residuals.push_back({i, portable::hypot(difference.x(), difference.y()), std::abs(difference.z()),
                         std::sqrt(difference.dot(covariance.ldlt().solve(difference)))});
  }
  std::stable_sort(residuals.begin(), residuals.end(),
                   [](const LoopResidual& a, const LoopResidual& b) { return a.chi > b.chi; });
  return residuals;
}

}  // namespace psi_slam
