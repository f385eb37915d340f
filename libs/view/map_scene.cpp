// SPDX-License-Identifier: BSD-3-Clause
#include "view/map_scene.h"

#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>

#include <utility>

#include "view/layers.h"
#include "view/frame_pose.h"
#include "view/palette.h"

namespace psi_slam {
namespace {

constexpr std::array<const char*, kMapLayers> kNames{"Gridmap",
                                                     "Active local maps",
                                                     "Odometry alone",
                                                     "Corrected path",
                                                     "Constraints of local maps",
                                                     "Nodes",
                                                     "Loops",
                                                     "Scan",
                                                     "Robot",
                                                     "Search windows"};

constexpr const char* kMaps = "main";
constexpr const char* kLines = "lines";
constexpr const char* kMarks = "marks";
constexpr const char* kLegend = "legend";

const char* viewport_of(MapLayer layer) {
  switch (layer) {
    case MapLayer::kGrid:
    case MapLayer::kLocalMaps:
      return kMaps;
    case MapLayer::kOdometry:
    case MapLayer::kTrajectory:
    case MapLayer::kConstraints:
    case MapLayer::kLoops:
      return kLines;
    case MapLayer::kNodes:
    case MapLayer::kScan:
    case MapLayer::kRobot:
    case MapLayer::kWindows:
      return kMarks;
  }
  return kMaps;
}

}  // namespace

const char* name_of(MapLayer layer) {
  return kNames[static_cast<std::size_t>(layer)];
}

bool shown_at_first(MapLayer layer) {
  return layer != MapLayer::kConstraints && layer != MapLayer::kNodes && layer != MapLayer::kLocalMaps;
}

MapScene::MapScene() {
  scene_->getViewport()->setCustomBackgroundColor(mrpt::img::TColorf(palette::kBackground));
  for (const char* upper : {kLines, kMarks}) {
    const auto viewport = scene_->createViewport(upper);
    viewport->setTransparent(true);
    viewport->setClonedCameraFrom(kMaps);
  }
  scene_->createViewport(kLegend)->setTransparent(true);
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    layers_[i] = mrpt::opengl::CSetOfObjects::Create();
    layers_[i]->setName(kNames[i]);
    layers_[i]->setVisibility(shown_at_first(static_cast<MapLayer>(i)));
    scene_->insert(layers_[i], viewport_of(static_cast<MapLayer>(i)));
  }
  scene_->insert(chosen_layer_, kMarks);
  scene_->insert(measure_layer_, kMarks);
}

void MapScene::set_clip_distances(double nearest_m, double farthest_m) {
  for (const auto& viewport : scene_->viewports())
    viewport->setViewportClipDistances(static_cast<float>(nearest_m), static_cast<float>(farthest_m));
}

mrpt::opengl::CSetOfObjects& MapScene::of(MapLayer layer) {
  return *layers_[static_cast<std::size_t>(layer)];
}

const mrpt::opengl::CSetOfObjects& MapScene::layer(MapLayer layer) const {
  return *layers_[static_cast<std::size_t>(layer)];
}

void MapScene::set_pixel_scale(float scale) {
  if (scale == pixel_scale_) return;
  pixel_scale_ = scale;
  shown_ = {};
}

void MapScene::set_legend(mrpt::img::CImage picture, int margin_px) {
  const auto viewport = scene_->getViewport(kLegend);
  const bool empty = picture.isEmpty();
  viewport->setTransparent(empty);
  if (empty) {
    viewport->setNormalMode();
    return;
  }
  viewport->setViewportPosition(margin_px, margin_px, static_cast<double>(picture.getWidth()),
                                static_cast<double>(picture.getHeight()));
  viewport->setImageView(std::move(picture));
}

/// Anew, with lines and points as large as the screen asks for.
void MapScene::fill(SceneLayer& layer, const Fill& draw) const {
  draw(layer);
  for (const auto& object : layer) {
    if (const auto lines = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(object))
      lines->setLineWidth(lines->getLineWidth() * pixel_scale_);
    if (const auto dots = std::dynamic_pointer_cast<mrpt::opengl::CPointCloud>(object))
      dots->setPointSize(dots->getPointSize() * pixel_scale_);
  }
}

void MapScene::set_visible(MapLayer layer, bool visible) {
  of(layer).setVisibility(visible);
  if (visible) shown_.snapshot.reset();  // nothing was drawn into it meanwhile
}

bool MapScene::visible(MapLayer layer) const {
  return this->layer(layer).isVisible();
}

void MapScene::set_measure(const std::optional<Measure>& measure) {
  measure_layer_->clear();
  if (measure) fill(*measure_layer_, [&](SceneLayer& layer) { draw_measure(layer, *measure); });
}

bool MapScene::show(const std::shared_ptr<const ReplaySnapshot>& snapshot,
                    const std::shared_ptr<const DrawnMap>& map, std::optional<std::size_t> frame) {
  const bool first = shown_.snapshot == nullptr;
  bool changed = false;
  if (map != shown_.map) {
    of(MapLayer::kGrid).clear();
    if (map) draw_grid(of(MapLayer::kGrid), *map);
    changed = true;
  }
  const bool poses_changed = first || snapshot->map_T_node != shown_.snapshot->map_T_node;
  const bool frames_changed = first || snapshot->frames.size() != shown_.snapshot->frames.size() ||
                              snapshot->phase != shown_.snapshot->phase;
  // Large layers are not drawn while nobody sees them.
  if (frames_changed && visible(MapLayer::kOdometry))
    fill(of(MapLayer::kOdometry), [&](SceneLayer& layer) { draw_odometry(layer, *snapshot); });
  if ((poses_changed || frames_changed) && visible(MapLayer::kTrajectory))
    fill(of(MapLayer::kTrajectory), [&](SceneLayer& layer) { draw_trajectory(layer, *snapshot); });
  changed = show_graph(*snapshot, poses_changed) || changed;
  changed = show_robot(*snapshot, frame, poses_changed || frames_changed || frame != shown_.frame) || changed;
  shown_ = {snapshot, map, frame, loop_style_, chosen_loop_};
  return changed || poses_changed || frames_changed;
}

bool MapScene::show_graph(const ReplaySnapshot& snapshot, bool poses_changed) {
  const bool first = shown_.snapshot == nullptr;
  const auto active_changed = [&] {
    const auto& before = shown_.snapshot->active_local_maps;
    const auto& now = snapshot.active_local_maps;
    return before.size() != now.size() || (!now.empty() && before.front().occupancy != now.front().occupancy);
  };
  const bool maps_changed = first || active_changed();
  if (visible(MapLayer::kLocalMaps)) {
    if (maps_changed) draw_local_maps(of(MapLayer::kLocalMaps), snapshot);
    if (maps_changed || poses_changed) place_local_maps(of(MapLayer::kLocalMaps), snapshot);
  }
  if (poses_changed) {
    if (visible(MapLayer::kNodes))
      fill(of(MapLayer::kNodes), [&](SceneLayer& layer) { draw_nodes(layer, snapshot); });
    if (visible(MapLayer::kConstraints))
      fill(of(MapLayer::kConstraints), [&](SceneLayer& layer) { draw_constraints(layer, snapshot); });
  }
  const bool loops_changed =
      poses_changed || snapshot.loops != shown_.snapshot->loops || !(loop_style_ == shown_.loop_style);
  if (loops_changed && visible(MapLayer::kLoops))
    fill(of(MapLayer::kLoops), [&](SceneLayer& layer) { draw_loops(layer, snapshot, loop_style_); });
  const bool chosen_changed = loops_changed || chosen_loop_ != shown_.chosen_loop;
  if (chosen_changed) {
    chosen_layer_->clear();
    if (chosen_loop_ && *chosen_loop_ < snapshot.loops->size())
      fill(*chosen_layer_, [&](SceneLayer& layer) {
        draw_chosen_loop(layer, snapshot, *chosen_loop_);
        draw_loop_window(layer, snapshot, *chosen_loop_);
      });
  }
  return maps_changed || loops_changed || chosen_changed;
}

bool MapScene::show_robot(const ReplaySnapshot& snapshot, std::optional<std::size_t> frame, bool changed) {
  if (!changed) return false;
  for (const MapLayer layer : {MapLayer::kScan, MapLayer::kRobot, MapLayer::kWindows}) of(layer).clear();
  if (snapshot.frames.empty()) return true;
  const std::size_t index = std::min(frame.value_or(snapshot.frames.size() - 1), snapshot.frames.size() - 1);
  const mrpt::math::TPose2D map_T_robot = map_T_frame(snapshot, index);
  fill(of(MapLayer::kScan), [&](SceneLayer& layer) { draw_scan(layer, snapshot.log[index], map_T_robot); });
  draw_robot(of(MapLayer::kRobot), map_T_robot);
  fill(of(MapLayer::kWindows), [&](SceneLayer& layer) { draw_windows(layer, snapshot, index); });
  return true;
}

}  // namespace psi_slam
