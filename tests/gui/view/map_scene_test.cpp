// SPDX-License-Identifier: BSD-3-Clause
#include "gui/map_scene.h"

#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CTexturedPlane.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include "gui/layers.h"
#include "gui/palette.h"
#include "replayed_room.h"

namespace psi_slam {
namespace {

class MapSceneTest : public ReplayedRoom {
 protected:
  template <class Object>
  typename Object::Ptr first(MapLayer layer) const {
    return std::dynamic_pointer_cast<Object>(*scene_.layer(layer).begin());
  }
  std::size_t objects(MapLayer layer) const {
    return static_cast<std::size_t>(std::distance(scene_.layer(layer).begin(), scene_.layer(layer).end()));
  }
  std::size_t loop_lines() const {
    std::size_t count = 0;
    for (const auto& lines : scene_.layer(MapLayer::kLoops))
      count += std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(lines)->size();
    return count;
  }
  std::size_t loops(bool (*condition)(const LoopRecord&)) const {
    return static_cast<std::size_t>(
        std::count_if(finished_->loops->begin(), finished_->loops->end(), condition));
  }

  MapScene scene_;
};

TEST_F(MapSceneTest, draws_a_finished_run) {
  scene_.set_visible(MapLayer::kNodes, true);
  EXPECT_TRUE(scene_.show(finished_, map_));
  float x_min = 0, x_max = 0, y_min = 0, y_max = 0;
  first<mrpt::opengl::CTexturedPlane>(MapLayer::kGrid)->getPlaneCorners(x_min, x_max, y_min, y_max);
  EXPECT_NEAR(x_max - x_min, map_->raster.width_px * map_->raster.resolution_m, 1e-3);
  EXPECT_NEAR(static_cast<double>(y_max), map_->raster.y_max_m, 1e-4);
  EXPECT_EQ(first<mrpt::opengl::CPointCloud>(MapLayer::kNodes)->size(), finished_->map_T_node->size());
  EXPECT_GT(first<mrpt::opengl::CPointCloud>(MapLayer::kScan)->size(), 100U);
  EXPECT_GT(first<mrpt::opengl::CSetOfLines>(MapLayer::kTrajectory)->size(), 50U);
  EXPECT_GT(first<mrpt::opengl::CSetOfLines>(MapLayer::kOdometry)->size(), 50U);
  EXPECT_EQ(objects(MapLayer::kLocalMaps), 0U) << "no local map is active after the end";
}

TEST_F(MapSceneTest, marks_unmatched_scans_on_the_path) {
  scene_.show(finished_, map_);
  EXPECT_EQ(objects(MapLayer::kTrajectory), 1U) << "the layer has only the path";
  auto snapshot = std::make_shared<ReplaySnapshot>(*finished_);
  UnmatchedStretch stretch;
  stretch.first_frame = 20;
  stretch.last_frame = 22;
  snapshot->unmatched = std::make_shared<UnmatchedScans>(UnmatchedScans{3, {stretch}});
  MapScene scene;
  scene.show(snapshot, map_);
  const auto dots = std::dynamic_pointer_cast<mrpt::opengl::CPointCloud>(
      *std::next(scene.layer(MapLayer::kTrajectory).begin()));
  ASSERT_EQ(dots->size(), 3U);
  EXPECT_NEAR(static_cast<double>(dots->getPoint3Df(0).x), snapshot->frames[20].map_T_robot.x, 1e-4);
}

TEST_F(MapSceneTest, draws_ellipses_of_uncertainty_true_to_scale) {
  scene_.set_visible(MapLayer::kUncertainty, true);
  auto snapshot = std::make_shared<ReplaySnapshot>(*finished_);
  const Eigen::Matrix3d covariance = Eigen::Vector3d(0.04, 0.01, 0.001).asDiagonal();
  snapshot->map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(
      std::vector<mrpt::math::TPose2D>{{0, 0, 0}, {0.5, 0, 0}, {3, 1, 0}, {9, 9, 0}});
  snapshot->loops = std::make_shared<std::vector<LoopRecord>>();  // they refer to other nodes
  snapshot->node_covariances = std::make_shared<std::vector<std::optional<Eigen::Matrix3d>>>(
      std::vector<std::optional<Eigen::Matrix3d>>{Eigen::Matrix3d::Zero(), covariance, covariance,
                                                  std::nullopt});
  scene_.show(snapshot, map_);
  const auto lines = first<mrpt::opengl::CSetOfLines>(MapLayer::kUncertainty);
  ASSERT_EQ(lines->size(), 48U)
      << "the second node is too close to the first, the place of the last is unknown";
  double x_max_m = 0;
  double y_max_m = 0;
  for (std::size_t i = 0; i < lines->size(); ++i) {
    double x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
    lines->getLineByIndex(i, x0, y0, z0, x1, y1, z1);
    x_max_m = std::max(x_max_m, x0);
    y_max_m = std::max(y_max_m, y0);
  }
  EXPECT_NEAR(x_max_m, 3 + 0.2 * std::sqrt(5.991), 0.01);
  EXPECT_NEAR(y_max_m, 1 + 0.1 * std::sqrt(5.991), 0.01);
}

TEST_F(MapSceneTest, draws_uncertainty_of_finished_runs_only) {
  scene_.set_visible(MapLayer::kUncertainty, true);
  scene_.show(paused_, nullptr);
  EXPECT_EQ(objects(MapLayer::kUncertainty), 0U);
  scene_.show(finished_, map_);
  EXPECT_EQ(finished_->node_covariances->size(), finished_->map_T_node->size());
  EXPECT_GT(first<mrpt::opengl::CSetOfLines>(MapLayer::kUncertainty)->size(), 48U);
}

TEST_F(MapSceneTest, draws_a_ring_and_the_suspect_of_each_hot_spot) {
  scene_.show(finished_, map_);
  ASSERT_TRUE(finished_->verdict);
  EXPECT_EQ(finished_->verdict->state, MapState::kGood);
  EXPECT_EQ(objects(MapLayer::kHotSpots), 0U);

  auto snapshot = std::make_shared<ReplaySnapshot>(*finished_);
  HotSpot spot;
  spot.at = {3, 1};
  spot.error_m = 0.4;
  spot.suspect.at = {5, 2};
  MapVerdict verdict;
  verdict.hot_spots = {spot, spot};
  verdict.hot_spots[1].at = {8, 1};
  snapshot->verdict = std::make_shared<MapVerdict>(verdict);
  MapScene scene;
  scene.show(snapshot, map_);
  const auto& layer = scene.layer(MapLayer::kHotSpots);
  const auto ring = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(*layer.begin());
  ASSERT_TRUE(ring);
  double x_max_m = 0;
  for (std::size_t i = 0; i < ring->size(); ++i) {
    double x0 = 0, y0 = 0, z0 = 0, x1 = 0, y1 = 0, z1 = 0;
    ring->getLineByIndex(i, x0, y0, z0, x1, y1, z1);
    x_max_m = std::max(x_max_m, x0);
  }
  EXPECT_NEAR(x_max_m, 3.75, 0.01);
  const auto dots = std::dynamic_pointer_cast<mrpt::opengl::CPointCloud>(*std::next(layer.begin(), 3));
  ASSERT_TRUE(dots);
  EXPECT_EQ(dots->size(), 2U);

  EXPECT_EQ(hot_spot_at(*snapshot, {7.5, 1}), &snapshot->verdict->hot_spots[1]);
  EXPECT_EQ(hot_spot_at(*snapshot, {5, 2}), nullptr) << "the suspect is no hot spot";
  EXPECT_EQ(hot_spot_at(*paused_, {3, 1}), nullptr);
  const std::string hint = hot_spot_hint(spot);
  EXPECT_EQ(hint.substr(0, 35), "Doubled wall at (3.0, 1.0) m, error");
  EXPECT_NE(hint.find(".\nTry: "), std::string::npos);
}

TEST_F(MapSceneTest, shows_zones_and_drafts) {
  scene_.show(finished_, map_);
  EXPECT_EQ(objects(MapLayer::kZones), 0U);
  DrawnMap with_zone = *map_;
  DrawnZones zones{MapEdit::Kind::kSlow, map_->raster};
  with_zone.zones.push_back(zones);
  scene_.show(finished_, std::make_shared<DrawnMap>(with_zone));
  EXPECT_EQ(objects(MapLayer::kZones), 1U);
  scene_.show(finished_, map_);
  EXPECT_EQ(objects(MapLayer::kZones), 0U);
  scene_.set_draft({{{0, 0}}, true, palette::kMeasure});  // a single point is no line
  scene_.set_draft({{}, true, palette::kMeasure});
}

TEST_F(MapSceneTest, forgets_ellipses_when_loops_are_edited) {
  scene_.set_visible(MapLayer::kUncertainty, true);
  scene_.show(finished_, map_);
  EXPECT_EQ(objects(MapLayer::kUncertainty), 1U);
  auto edited = std::make_shared<ReplaySnapshot>(*finished_);
  edited->node_covariances = std::make_shared<std::vector<std::optional<Eigen::Matrix3d>>>();
  EXPECT_TRUE(scene_.show(edited, map_));
  EXPECT_EQ(objects(MapLayer::kUncertainty), 0U);
}

TEST_F(MapSceneTest, draws_the_active_local_maps_of_a_run_in_progress) {
  scene_.show(paused_, nullptr);
  EXPECT_EQ(objects(MapLayer::kLocalMaps), 0U) << "the layer is hidden";
  scene_.set_visible(MapLayer::kLocalMaps, true);
  scene_.show(paused_, nullptr);
  EXPECT_EQ(objects(MapLayer::kLocalMaps), paused_->active_local_maps.size());
  EXPECT_GT(objects(MapLayer::kLocalMaps), 0U);
  EXPECT_EQ(objects(MapLayer::kGrid), 0U);
}

TEST_F(MapSceneTest, draws_accepted_loops_and_rejected_ones_on_request) {
  scene_.show(finished_, map_);
  ASSERT_GT(loops([](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; }), 0U);
  EXPECT_EQ(loop_lines(), finished_->loops->size() - loops([](const LoopRecord& loop) {
                            return loop.state == LoopState::kRejected && !is_outlier(loop);
                          }));
  scene_.set_loop_style({LoopStyle::Colour::kMatcher, true});
  EXPECT_TRUE(scene_.show(finished_, map_));
  EXPECT_EQ(loop_lines(), finished_->loops->size() - loops(found_nothing))
      << "loops without a match have no line";
}

TEST_F(MapSceneTest, draws_as_many_loops_as_the_report) {
  auto snapshot = std::make_shared<ReplaySnapshot>(*finished_);
  LoopRecord loop = finished_->loops->front();
  loop.state = LoopState::kAccepted;
  std::vector<LoopRecord> many(1200, loop);
  many[7].by_hand = true;
  snapshot->loops = std::make_shared<std::vector<LoopRecord>>(many);
  scene_.show(snapshot, map_);
  EXPECT_EQ(loop_lines(), 501U) << "500 loops, and the one that a person edited";
}

TEST_F(MapSceneTest, colours_loops_by_matcher_or_residual) {
  scene_.show(finished_, map_);
  const auto colour = [&] { return first<mrpt::opengl::CSetOfLines>(MapLayer::kLoops)->getColor_u8(); };
  EXPECT_TRUE(std::any_of(finished_->loops->begin(), finished_->loops->end(), [&](const LoopRecord& loop) {
    return loop.state == LoopState::kAccepted && matcher_colour(loop.matcher).G == colour().G;
  }));
  EXPECT_NE(colour().G, heat_colour(0).G);
  scene_.set_loop_style({LoopStyle::Colour::kResidual, false});
  scene_.show(finished_, map_);
  EXPECT_EQ(colour().G, heat_colour(0).G) << "the loops of the simulated room have small residuals";
}

TEST_F(MapSceneTest, draws_the_search_windows_of_a_scan_and_its_loops) {
  const auto first_loop = std::find_if(finished_->loops->begin(), finished_->loops->end(),
                                       [](const LoopRecord& loop) { return !loop.in_final_search; });
  ASSERT_NE(first_loop, finished_->loops->end());
  const auto lines = [&](std::size_t frame) {
    scene_.show(finished_, map_, frame);
    return first<mrpt::opengl::CSetOfLines>(MapLayer::kWindows)->size();
  };
  EXPECT_EQ(lines(1), 6U) << "the window has four sides and two limits of the heading";
  EXPECT_GE(lines(first_loop->frame), 12U);
}

TEST_F(MapSceneTest, redraws_nothing_without_a_change) {
  scene_.show(finished_, map_);
  const auto grid = *scene_.layer(MapLayer::kGrid).begin();
  EXPECT_FALSE(scene_.show(finished_, map_));
  EXPECT_EQ(*scene_.layer(MapLayer::kGrid).begin(), grid);
  EXPECT_TRUE(scene_.show(finished_, map_, 10)) << "another scan is shown";
  EXPECT_FALSE(scene_.show(finished_, map_, 10));
}

TEST_F(MapSceneTest, reduces_maps_that_are_larger_than_the_screen) {
  const auto width_px = [&] {
    return first<mrpt::opengl::CTexturedPlane>(MapLayer::kGrid)->getTextureImage().getWidth();
  };
  const auto whole_px = static_cast<std::size_t>(map_->raster.width_px);
  scene_.show(finished_, map_);
  EXPECT_EQ(width_px(), whole_px);
  scene_.set_ground_pixel(3 * map_->raster.resolution_m);
  EXPECT_TRUE(scene_.show(finished_, map_));
  EXPECT_EQ(width_px(), (whole_px + 3) / 4);
  scene_.set_ground_pixel(3.5 * map_->raster.resolution_m);
  EXPECT_FALSE(scene_.show(finished_, map_)) << "the level is the same";
  scene_.set_ground_pixel(0.5 * map_->raster.resolution_m);
  EXPECT_TRUE(scene_.show(finished_, map_));
  EXPECT_EQ(width_px(), whole_px);

  scene_.set_visible(MapLayer::kLocalMaps, true);
  scene_.show(paused_, nullptr);
  const auto local_width_px = [&] {
    return first<mrpt::opengl::CTexturedPlane>(MapLayer::kLocalMaps)->getTextureImage().getWidth();
  };
  const std::size_t whole_local_px = local_width_px();
  scene_.set_ground_pixel(1);
  EXPECT_TRUE(scene_.show(paused_, nullptr));
  EXPECT_LT(local_width_px(), whole_local_px);
}

TEST_F(MapSceneTest, shows_and_hides_layers) {
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    const auto layer = static_cast<MapLayer>(i);
    EXPECT_EQ(scene_.visible(layer), shown_at_first(layer)) << name_of(layer);
    scene_.set_visible(layer, !shown_at_first(layer));
    EXPECT_NE(scene_.visible(layer), shown_at_first(layer)) << name_of(layer);
  }
}

TEST_F(MapSceneTest, scales_lines_and_points_with_the_desktop) {
  scene_.show(finished_, map_);
  const float width = first<mrpt::opengl::CSetOfLines>(MapLayer::kTrajectory)->getLineWidth();
  const float dot = first<mrpt::opengl::CPointCloud>(MapLayer::kScan)->getPointSize();
  scene_.set_pixel_scale(2);
  EXPECT_TRUE(scene_.show(finished_, map_)) << "everything is drawn again";
  EXPECT_EQ(first<mrpt::opengl::CSetOfLines>(MapLayer::kTrajectory)->getLineWidth(), 2 * width);
  EXPECT_EQ(first<mrpt::opengl::CPointCloud>(MapLayer::kScan)->getPointSize(), 2 * dot);
  scene_.show(finished_, map_, 10);
  EXPECT_EQ(first<mrpt::opengl::CPointCloud>(MapLayer::kScan)->getPointSize(), 2 * dot)
      << "the points are scaled once, not twice";
}

TEST_F(MapSceneTest, updates_a_layer_when_it_becomes_visible) {
  scene_.show(finished_, map_);
  EXPECT_EQ(objects(MapLayer::kConstraints), 0U);
  scene_.set_visible(MapLayer::kConstraints, true);
  EXPECT_TRUE(scene_.show(finished_, map_));
  EXPECT_GT(first<mrpt::opengl::CSetOfLines>(MapLayer::kConstraints)->size(), 50U);
}

TEST(MapSceneOfTwoLasers, shows_the_points_of_both) {
  Frame frame;
  frame.scan.bearings_rad = std::make_shared<const std::vector<float>>(std::vector<float>{-0.5F, 0, 0.5F});
  frame.scan.ranges_m = {1, 2, 3};
  frame.scan.max_range_m = 10;
  CompanionScan rear{frame.scan, 0, {}};
  rear.scan.laser = 1;
  rear.scan.max_range_m = 30;
  rear.scan.ranges_m = {20, 21, 22};
  rear.scan.robot_T_laser = {-0.3, 0, M_PI};
  frame.companions = {rear};
  SharedHistory<Frame> log;
  log.push_back(frame);
  SharedHistory<FrameRecord> frames;
  FrameRecord record;
  record.map_T_robot = {5, 0, 0};
  frames.push_back(record);
  auto snapshot = std::make_shared<ReplaySnapshot>();
  snapshot->log = log.view();
  snapshot->frames = frames.view();
  snapshot->phase = ReplayPhase::kFinished;
  MapScene scene;
  scene.show(snapshot, nullptr);
  const auto points =
      std::dynamic_pointer_cast<mrpt::opengl::CPointCloud>(*scene.layer(MapLayer::kScan).begin());
  ASSERT_EQ(points->size(), 6U);
  EXPECT_NEAR(points->getPoint3Df(4).x, 5 - 0.3 - 21, 1e-4);
}

}  // namespace
}  // namespace psi_slam
