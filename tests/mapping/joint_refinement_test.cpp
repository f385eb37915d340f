// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/joint_refinement.h"

#include <gtest/gtest.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "local_maps/simulated_drive.h"
#include "base/random_draws.h"
#include "mapping/local_maps/scan_filter.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A run through an office, with small random errors of all poses.
struct NoisyPoses {
  SimulatedDrive drive =
      drive_along(office_floor(), path_along({{1.6, 1.6}, {8, 1.6}, {1.6, 1.6}}, 0.05, 0.08), {}, 3);
  RefinedScans scans;

  explicit NoisyPoses(double sigma_m = 0.01, double sigma_rad = 0.004) {
    RandomDraws random(3, "graph", 0);
    for (std::size_t i = 0; i < drive.map_T_robot.size(); ++i) {
      scans.map_T_frame.push_back(drive.map_T_robot[i] + TPose2D(sigma_m * random.normal(),
                                                                 sigma_m * random.normal(),
                                                                 sigma_rad * random.normal()));
      if (i % 3 == 0) scans.node_frames.push_back(i);
    }
    scans.points = [this](std::size_t frame) { return matching_points(drive.frames[frame].scan, {}); };
  }
};

struct Errors {
  double along_m = 0;  // along x, the direction of the corridor
  double across_m = 0;
  double rad = 0;
};

// Mean absolute errors of the motion from each frame to the fifth frame after it.
Errors errors_of(const std::vector<TPose2D>& poses, const std::vector<TPose2D>& truth) {
  Errors errors;
  const std::size_t count = poses.size() - 5;
  for (std::size_t i = 0; i < count; ++i) {
    const TPose2D off = (poses[i + 5] - poses[i]) - (truth[i + 5] - truth[i]);
    errors.along_m += std::abs(off.x) / static_cast<double>(count);
    errors.across_m += std::abs(off.y) / static_cast<double>(count);
    errors.rad += std::abs(mrpt::math::wrapToPi(off.phi)) / static_cast<double>(count);
  }
  return errors;
}

const auto kGoOn = [](double) { return true; };

TEST(JointRefinement, removes_the_noise_of_poses) {
  NoisyPoses noisy;
  const Errors before = errors_of(noisy.scans.map_T_frame, noisy.drive.map_T_robot);
  WorkerPool pool(1);
  refine_jointly(noisy.scans, {}, pool, kGoOn);
  const Errors after = errors_of(noisy.scans.map_T_frame, noisy.drive.map_T_robot);
  EXPECT_LT(after.along_m, before.along_m);
  EXPECT_LT(after.across_m, 0.5 * before.across_m);
  EXPECT_LT(after.rad, 0.5 * before.rad);
}

TEST(JointRefinement, keeps_correct_poses) {
  NoisyPoses exact(0, 0);
  WorkerPool pool(1);
  refine_jointly(exact.scans, {}, pool, kGoOn);
  const Errors after = errors_of(exact.scans.map_T_frame, exact.drive.map_T_robot);
  EXPECT_LT(after.along_m, 0.006);
  EXPECT_LT(after.across_m, 0.004);
  EXPECT_LT(after.rad, 0.0015);
}

TEST(JointRefinement, does_not_depend_on_the_number_of_threads) {
  NoisyPoses one;
  NoisyPoses three;
  WorkerPool pool_of_one(1);
  WorkerPool pool_of_three(3);
  refine_jointly(one.scans, {}, pool_of_one, kGoOn);
  refine_jointly(three.scans, {}, pool_of_three, kGoOn);
  EXPECT_EQ(one.scans.map_T_frame, three.scans.map_T_frame);
}

TEST(JointRefinement, refines_the_frames_before_the_first_node_too) {
  NoisyPoses noisy;
  noisy.scans.node_frames.erase(noisy.scans.node_frames.begin());
  const std::vector<TPose2D> before = noisy.scans.map_T_frame;
  WorkerPool pool(1);
  refine_jointly(noisy.scans, {}, pool, kGoOn);
  ASSERT_EQ(noisy.scans.map_T_frame.size(), before.size());
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_NE(noisy.scans.map_T_frame[i], before[i]) << "frame " << i;
}

TEST(JointRefinement, changes_nothing_when_stopped_at_once_or_without_rounds) {
  NoisyPoses noisy;
  const std::vector<TPose2D> before = noisy.scans.map_T_frame;
  WorkerPool pool(1);
  refine_jointly(noisy.scans, {}, pool, [](double) { return false; });
  EXPECT_EQ(noisy.scans.map_T_frame, before);
  JointRefinementOptions none;
  none.rounds = 0;
  refine_jointly(noisy.scans, none, pool, kGoOn);
  EXPECT_EQ(noisy.scans.map_T_frame, before);
}

TEST(JointRefinement, keeps_finished_rounds_when_stopped) {
  NoisyPoses once;
  NoisyPoses stopped;
  WorkerPool pool(1);
  refine_jointly(once.scans, {}, pool, kGoOn);
  JointRefinementOptions twice;
  twice.rounds = 2;
  refine_jointly(stopped.scans, twice, pool, [](double share) { return share < 0.5; });
  EXPECT_EQ(stopped.scans.map_T_frame, once.scans.map_T_frame);
}

TEST(JointRefinement, reports_its_progress) {
  NoisyPoses noisy;
  JointRefinementOptions options;
  options.rounds = 2;
  std::vector<double> told;
  WorkerPool pool(1);
  refine_jointly(noisy.scans, options, pool, [&](double share) {
    told.push_back(share);
    return true;
  });
  ASSERT_GE(told.size(), 4U);
  EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
  EXPECT_DOUBLE_EQ(told.back(), 1);
}

TEST(JointRefinement, accepts_an_empty_log) {
  RefinedScans scans;
  WorkerPool pool(1);
  refine_jointly(scans, {}, pool, kGoOn);
  EXPECT_TRUE(scans.map_T_frame.empty());
}

}  // namespace
}  // namespace psi_slam
