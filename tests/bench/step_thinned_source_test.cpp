// SPDX-License-Identifier: BSD-3-Clause
#include "sparse/step_thinned_source.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "base/random_draws.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

/// Odometry of random steps that turns, stands still and crosses +-180 degrees.
std::vector<TPose2D> random_odometry(std::uint64_t seed, std::size_t scans) {
  RandomDraws draws(seed, "odometry", 0);
  std::vector<TPose2D> poses{{3, -4, 3}};
  while (poses.size() < scans) {
    TPose2D pose = poses.back() + TPose2D(0.3 * draws.share(), 0.05 * draws.normal(), 0.15 * draws.normal());
    pose.normalizePhi();
    poses.push_back(draws.share() < 0.2 ? poses.back() : pose);
  }
  return poses;
}

class PoseSource : public FrameSource {
 public:
  explicit PoseSource(std::vector<TPose2D> poses, bool has_odometry = true)
      : poses_(std::move(poses)), has_odometry_(has_odometry) {}
  std::optional<Frame> next() override {
    if (next_ == poses_.size()) return std::nullopt;
    Frame frame;
    frame.index = next_;
    frame.time_us = static_cast<TimeUs>(next_) * 1000;
    frame.odom_T_robot = poses_[next_++];
    frame.has_odometry = has_odometry_;
    return frame;
  }
  double progress() const override { return static_cast<double>(next_) / static_cast<double>(poses_.size()); }

 private:
  std::vector<TPose2D> poses_;
  bool has_odometry_;
  std::size_t next_ = 0;
};

StepThinnedSource thinned(const std::vector<TPose2D>& odometry, const ThinningStep& step) {
  return {std::make_unique<PoseSource>(odometry), step};
}

/// Indices of the kept scans, as a reference. Compares each scan with the last kept scan, and angles by their
/// cosine.
std::vector<std::size_t> slowly_kept(const std::vector<TPose2D>& odometry, const ThinningStep& step) {
  std::vector<std::size_t> kept{0};
  for (std::size_t i = 1; i < odometry.size(); ++i) {
    const TPose2D& a = odometry[kept.back()];
    const TPose2D& b = odometry[i];
    const double way_m = std::sqrt(std::pow(b.x - a.x, 2) + std::pow(b.y - a.y, 2));
    const double turn_rad = std::acos(std::clamp(std::cos(b.phi - a.phi), -1.0, 1.0));
    if (way_m >= step.distance_m || turn_rad >= step.turn_rad) kept.push_back(i);
  }
  return kept;
}

/// Map pose of a removed scan, as a reference. Moves the last kept scan by odometry, with the rotation
/// written out.
TPose2D slowly_put_back(const TPose2D& odom_T_kept, const TPose2D& odom_T_scan, const TPose2D& map_T_kept) {
  const double turn_rad = map_T_kept.phi - odom_T_kept.phi;
  const double x = odom_T_scan.x - odom_T_kept.x;
  const double y = odom_T_scan.y - odom_T_kept.y;
  return {map_T_kept.x + std::cos(turn_rad) * x - std::sin(turn_rad) * y,
          map_T_kept.y + std::sin(turn_rad) * x + std::cos(turn_rad) * y, odom_T_scan.phi + turn_rad};
}

TEST(StepThinnedSource, keeps_the_scans_that_a_slow_search_keeps) {
  for (const ThinningStep step : {ThinningStep{1, 0.5}, ThinningStep{0.4, 3}, ThinningStep{100, 0.2}}) {
    const std::vector<TPose2D> odometry = random_odometry(7, 2000);
    StepThinnedSource source = thinned(odometry, step);
    const std::vector<std::size_t> expected = slowly_kept(odometry, step);
    std::size_t kept = 0;
    while (const std::optional<Frame> frame = source.next()) {
      ASSERT_LT(kept, expected.size());
      EXPECT_EQ(frame->index, kept);
      EXPECT_EQ(frame->time_us, static_cast<TimeUs>(expected[kept]) * 1000);
      EXPECT_EQ(frame->odom_T_robot, odometry[expected[kept]]);
      ++kept;
    }
    EXPECT_EQ(kept, expected.size());
    EXPECT_GT(kept, 20U);
    EXPECT_LT(kept, odometry.size() / 2);
    EXPECT_EQ(source.scans().size(), odometry.size());
    EXPECT_EQ(source.progress(), 1);
  }
}

TEST(StepThinnedSource, a_step_of_zero_keeps_every_scan) {
  const std::vector<TPose2D> odometry = random_odometry(2, 50);
  StepThinnedSource source = thinned(odometry, {0, 0});
  std::size_t kept = 0;
  while (source.next()) ++kept;
  EXPECT_EQ(kept, odometry.size());
}

TEST(StepThinnedSource, poses_put_back_are_the_last_kept_pose_and_odometry_since) {
  const ThinningStep step;
  const std::vector<TPose2D> odometry = random_odometry(5, 1000);
  StepThinnedSource source = thinned(odometry, step);
  while (source.next()) {
  }
  const std::vector<std::size_t> kept = slowly_kept(odometry, step);
  RandomDraws draws(1, "map", 0);
  std::vector<TPose2D> map_T_kept;
  for (std::size_t i = 0; i < kept.size(); ++i)
    map_T_kept.emplace_back(10 * draws.normal(), 10 * draws.normal(), draws.normal());
  const Trajectory path = put_poses_back(source.scans(), map_T_kept);
  ASSERT_EQ(path.size(), odometry.size());
  std::size_t last = 0;
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (last + 1 < kept.size() && kept[last + 1] == i) ++last;
    const TPose2D expected = slowly_put_back(odometry[kept[last]], odometry[i], map_T_kept[last]);
    EXPECT_EQ(path[i].time_us, static_cast<TimeUs>(i) * 1000);
    EXPECT_NEAR(path[i].pose.x, expected.x, 1e-9);
    EXPECT_NEAR(path[i].pose.y, expected.y, 1e-9);
    EXPECT_NEAR(std::remainder(path[i].pose.phi - expected.phi, 2 * M_PI), 0, 1e-9);
  }
}

TEST(StepThinnedSource, poses_of_kept_scans_are_chosen_from_those_of_all_scans) {
  const std::vector<TPose2D> odometry = random_odometry(9, 300);
  StepThinnedSource source = thinned(odometry, {});
  std::vector<TPose2D> kept;
  while (const std::optional<Frame> frame = source.next()) kept.push_back(frame->odom_T_robot);
  EXPECT_EQ(poses_of_kept(source.scans(), odometry), kept);
  const Trajectory path = put_poses_back(source.scans(), kept);
  for (std::size_t i = 0; i < path.size(); ++i)
    EXPECT_NEAR(std::hypot(path[i].pose.x - odometry[i].x, path[i].pose.y - odometry[i].y), 0, 1e-9)
        << "poses of odometry give odometry";
  kept.pop_back();
  EXPECT_THROW(put_poses_back(source.scans(), kept), std::out_of_range);
}

TEST(StepThinnedSource, refuses_scans_without_odometry_and_impossible_steps) {
  StepThinnedSource source(std::make_unique<PoseSource>(random_odometry(1, 3), false), {});
  EXPECT_THROW(source.next(), UserError);
  for (const double wrong : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(thinned({}, {wrong, 0.5}), std::invalid_argument);
    EXPECT_THROW(thinned({}, {1, wrong}), std::invalid_argument);
  }
}

}  // namespace
}  // namespace psi_slam
