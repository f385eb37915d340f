// SPDX-License-Identifier: BSD-3-Clause
#include "gui/map_scene.h"

#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>

#include <algorithm>

#include "gui/layers.h"
#include "gui/palette.h"
#include "gui/raster_levels.h"
#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_tolerance.h"

namespace psi_slam {
namespace {

// Frames of a robot that stands still, of which most have no ranges. Superseded scans have none either.
constexpr PoseTolerance kStandstill{0.05, 0.05};

constexpr const char* kMaps = "main";
constexpr const char* kAboveMaps = "above maps";
constexpr const char* kLines = "lines";
constexpr const char* kMarks = "marks";
constexpr const char* kLegend = "legend";

struct LayerFacts {
  const char* name;
  const char* viewport;
  bool shown_at_first;
};
constexpr std::array<LayerFacts, kMapLayers> kLayers{{{"Grid map", kMaps, true},
                                                      {"Active local maps", kMaps, false},
                                                      {"Odometry only", kLines, true},
                                                      {"Corrected path", kLines, true},
                                                      {"Nodes of local maps", kLines, false},
                                                      {"Nodes", kMarks, false},
                                                      {"Loops", kLines, true},
                                                      {"Scan", kMarks, true},
                                                      {"Robot", kMarks, true},
                                                      {"Search windows", kMarks, true},
                                                      {"Uncertainty (95 %)", kLines, false},
                                                      {"Zones", kAboveMaps, true},
                                                      {"Hot spots", kMarks, true}}};

bool active_maps_differ(const ReplaySnapshot& a, const ReplaySnapshot& b) {
  const auto& before = a.active_local_maps;
  const auto& now = b.active_local_maps;
  return before.size() != now.size() || (!now.empty() && before.front().occupancy != now.front().occupancy);
}

}  // namespace

const char* name_of(MapLayer layer) {
  return kLayers[static_cast<std::size_t>(layer)].name;
}

bool shown_at_first(MapLayer layer) {
  return kLayers[static_cast<std::size_t>(layer)].shown_at_first;
}

MapScene::MapScene() {
  scene_->getViewport()->setCustomBackgroundColor(mrpt::img::TColorf(palette::kBackground));
  for (const char* upper : {kAboveMaps, kLines, kMarks}) {
    const auto viewport = scene_->createViewport(upper);
    viewport->setTransparent(true);
    viewport->setClonedCameraFrom(kMaps);
  }
  scene_->createViewport(kLegend)->setTransparent(true);
  for (std::size_t i = 0; i < kMapLayers; ++i) {
    layers_[i] = mrpt::opengl::CSetOfObjects::Create();
    layers_[i]->setName(kLayers[i].name);
    layers_[i]->setVisibility(kLayers[i].shown_at_first);
    scene_->insert(layers_[i], kLayers[i].viewport);
  }
  scene_->insert(chosen_layer_, kMarks);
  scene_->insert(measure_layer_, kMarks);
  scene_->insert(draft_layer_, kMarks);
}

void MapScene::set_clip_distances(double nearest_m, double farthest_m) {
  for (const auto& viewport : scene_->viewports())
    viewport->setViewportClipDistances(static_cast<float>(nearest_m), static_cast<float>(farthest_m));
}

void MapScene::set_pixel_scale(float scale) {
  if (scale == pixel_scale_) return;
  pixel_scale_ = scale;
  shown_ = {};
  draw_hand_lines();
}

void MapScene::set_legend(mrpt::img::CImage picture, int margin_px) {
  const auto viewport = scene_->getViewport(kLegend);
  const bool empty = picture.isEmpty();
  viewport->setTransparent(empty);
  if (empty) return viewport->setNormalMode();
  viewport->setViewportPosition(margin_px, margin_px, static_cast<double>(picture.getWidth()),
                                static_cast<double>(picture.getHeight()));
  viewport->setImageView(std::move(picture));
}

/// Replaces the objects of a layer, and scales its lines and points for the screen.
template <class Draw>
void MapScene::fill(SceneLayer& layer, const Draw& draw) const {
  layer.clear();
  draw(layer);
  for (const auto& object : layer) {
    if (const auto lines = std::dynamic_pointer_cast<mrpt::opengl::CSetOfLines>(object))
      lines->setLineWidth(lines->getLineWidth() * pixel_scale_);
    if (const auto dots = std::dynamic_pointer_cast<mrpt::opengl::CPointCloud>(object))
      dots->setPointSize(dots->getPointSize() * pixel_scale_);
  }
}

/// Draws the objects of a layer again, unless the layer is hidden. set_visible() makes show() redraw a hidden
/// layer later.
template <class Draw, class... Matter>
void MapScene::redraw(MapLayer layer, const Draw& draw, const Matter&... matter) {
  if (visible(layer)) fill(of(layer), [&](SceneLayer& objects) { draw(objects, matter...); });
}

void MapScene::set_visible(MapLayer layer, bool visible) {
  of(layer).setVisibility(visible);
  if (visible) shown_.snapshot.reset();
}

void MapScene::set_measure(const std::optional<Measure>& measure) {
  measure_ = measure;
  draw_hand_lines();
}

void MapScene::set_draft(const MapDraft& draft) {
  draft_ = draft;
  draw_hand_lines();
}

/// Draws the lines that a person is drawing: the measure and the draft.
void MapScene::draw_hand_lines() {
  fill(*measure_layer_, [&](SceneLayer& layer) {
    if (measure_) draw_measure(layer, *measure_);
  });
  fill(*draft_layer_, [&](SceneLayer& layer) { draw_draft(layer, draft_); });
}

bool MapScene::show(const std::shared_ptr<const ReplaySnapshot>& snapshot,
                    const std::shared_ptr<const DrawnMap>& map, std::optional<std::size_t> frame) {
  const bool first = shown_.snapshot == nullptr;
  const bool map_changed = show_maps(map);
  const bool poses_changed = first || snapshot->map_T_node != shown_.snapshot->map_T_node;
  const bool frames_changed = first || snapshot->frames.size() != shown_.snapshot->frames.size() ||
                              snapshot->phase != shown_.snapshot->phase;
  if (frames_changed) redraw(MapLayer::kOdometry, draw_odometry, *snapshot);
  if (poses_changed || frames_changed) redraw(MapLayer::kTrajectory, draw_trajectory, *snapshot);
  const bool graph_changed = show_graph(*snapshot, poses_changed);
  const bool robot_changed = poses_changed || frames_changed || frame != shown_.frame;
  if (robot_changed) show_robot(*snapshot, frame);
  shown_.snapshot = snapshot;
  shown_.frame = frame;
  shown_.loop_style = loop_style_;
  shown_.chosen_loop = chosen_loop_;
  return map_changed || graph_changed || robot_changed;
}

/// Draws the grid map and its zones if the map or the level of its raster has changed.
bool MapScene::show_maps(const std::shared_ptr<const DrawnMap>& map) {
  const int level = map ? raster_level(map->raster.resolution_m, ground_pixel_m_) : 0;
  if (map == shown_.map && level == shown_.grid_level) return false;
  fill(of(MapLayer::kGrid), [&](SceneLayer& layer) {
    if (map) draw_grid(layer, *map, level);
  });
  fill(of(MapLayer::kZones), [&](SceneLayer& layer) {
    if (map) draw_zones(layer, *map, level);
  });
  shown_.map = map;
  shown_.grid_level = level;
  return true;
}

/// Draws the active local maps if they or the level of their rasters have changed, and moves them.
bool MapScene::show_local_maps(const ReplaySnapshot& snapshot, bool poses_changed) {
  const auto& maps = snapshot.active_local_maps;
  const int level = maps.empty() ? 0
                                 : raster_level(static_cast<double>(maps.front().occupancy->getResolution()),
                                                ground_pixel_m_);
  const bool changed = shown_.snapshot == nullptr || level != shown_.local_map_level ||
                       active_maps_differ(*shown_.snapshot, snapshot);
  if (changed) redraw(MapLayer::kLocalMaps, draw_local_maps, snapshot, level);
  if ((changed || poses_changed) && visible(MapLayer::kLocalMaps))
    place_local_maps(of(MapLayer::kLocalMaps), snapshot);
  shown_.local_map_level = level;
  return changed;
}

bool MapScene::show_graph(const ReplaySnapshot& snapshot, bool poses_changed) {
  const bool maps_changed = show_local_maps(snapshot, poses_changed);
  if (poses_changed) {
    redraw(MapLayer::kNodes, draw_nodes, snapshot);
    redraw(MapLayer::kConstraints, draw_constraints, snapshot);
  }
  const bool covariances_changed =
      poses_changed || snapshot.node_covariances != shown_.snapshot->node_covariances;
  if (covariances_changed) redraw(MapLayer::kUncertainty, draw_uncertainty, snapshot);
  const bool verdict_changed = poses_changed || snapshot.verdict != shown_.snapshot->verdict;
  if (verdict_changed) redraw(MapLayer::kHotSpots, draw_hot_spots, snapshot);
  const bool loops_changed =
      poses_changed || snapshot.loops != shown_.snapshot->loops || !(loop_style_ == shown_.loop_style);
  if (loops_changed) redraw(MapLayer::kLoops, draw_loops, snapshot, loop_style_);
  const bool chosen_changed = loops_changed || chosen_loop_ != shown_.chosen_loop;
  if (chosen_changed)
    fill(*chosen_layer_, [&](SceneLayer& layer) {
      if (chosen_loop_ && *chosen_loop_ < snapshot.loops->size())
        draw_chosen_loop(layer, snapshot, *chosen_loop_);
    });
  return maps_changed || covariances_changed || verdict_changed || loops_changed || chosen_changed;
}

void MapScene::show_robot(const ReplaySnapshot& snapshot, std::optional<std::size_t> frame) {
  for (const MapLayer layer : {MapLayer::kScan, MapLayer::kRobot, MapLayer::kWindows}) of(layer).clear();
  if (snapshot.frames.empty()) return;
  const std::size_t index = std::min(frame.value_or(snapshot.frames.size() - 1), snapshot.frames.size() - 1);
  const mrpt::math::TPose2D map_T_robot = map_T_frame(snapshot, index);
  std::size_t scan = index;  // of a robot that stands still, the last scan that has ranges
  while (scan > 0 && !has_ranges(snapshot.log[scan]) &&
         is_same_place(map_T_frame(snapshot, scan - 1), map_T_robot, kStandstill))
    --scan;
  redraw(MapLayer::kScan, draw_scan, snapshot.log[scan], map_T_robot);
  redraw(MapLayer::kRobot, draw_robot, map_T_robot);
  redraw(MapLayer::kWindows, draw_windows, snapshot, index);
}

}  // namespace psi_slam
