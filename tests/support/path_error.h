// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <filesystem>
#include <vector>

#include "map/trajectory/trajectory_file.h"

namespace psi_slam {

/// Root mean square distance, in metres, of the positions of a trajectory file from those of the true
/// trajectory at the same times, after rigid alignment (Umeyama, 1991, without scale). Ignores times outside
/// the truth, and returns infinity if more than 1 % of the times are there.
inline double path_error_m(const std::filesystem::path& trajectory, const std::filesystem::path& truth) {
  constexpr TimeUs kMaxGap_us = 1'000'000;
  const Trajectory true_poses = read_trajectory(truth);
  std::vector<Eigen::Vector2d> found;
  std::vector<Eigen::Vector2d> expected;
  const Trajectory poses = read_trajectory(trajectory);
  for (const StampedPose& stamped : poses) {
    const auto at_time = pose_at_time(true_poses, stamped.time_us, kMaxGap_us);
    if (!at_time) continue;
    found.emplace_back(stamped.pose.x, stamped.pose.y);
    expected.emplace_back(at_time->pose.x, at_time->pose.y);
  }
  if (100 * (poses.size() - found.size()) > poses.size()) return std::numeric_limits<double>::infinity();
  const auto matrix = [](const std::vector<Eigen::Vector2d>& positions) -> Eigen::Matrix2Xd {
    return Eigen::Map<const Eigen::Matrix2Xd>(positions.front().data(), 2,
                                              static_cast<Eigen::Index>(positions.size()));
  };
  const Eigen::Matrix2Xd from = matrix(found);
  const Eigen::Matrix2Xd to = matrix(expected);
  const Eigen::Isometry2d to_T_from(Eigen::umeyama(from, to, false));
  return std::sqrt((to_T_from * from - to).colwise().squaredNorm().mean());
}

}  // namespace psi_slam
