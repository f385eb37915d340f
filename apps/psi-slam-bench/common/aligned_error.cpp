// SPDX-License-Identifier: BSD-3-Clause
#include "common/aligned_error.h"

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace psi_slam {
namespace {

using Positions = Eigen::Matrix2Xd;

Positions positions_of(const std::vector<mrpt::math::TPose2D>& path) {
  Positions positions(2, static_cast<Eigen::Index>(path.size()));
  Eigen::Index column = 0;
  for (const mrpt::math::TPose2D& pose : path) positions.col(column++) << pose.x, pose.y;
  return positions;
}

}  // namespace

double aligned_error_m(const std::vector<mrpt::math::TPose2D>& path,
                       const std::vector<mrpt::math::TPose2D>& truth) {
  const Positions from = positions_of(path);
  const Positions to = positions_of(truth);
  const Eigen::Isometry2d to_T_from(Eigen::umeyama(from, to, false));
  return (to_T_from * from - to).colwise().norm().mean();
}

}  // namespace psi_slam
