// SPDX-License-Identifier: BSD-3-Clause
#include "gui/layers.h"

#include <mrpt/opengl/CPointCloud.h>
#include <mrpt/opengl/CSetOfLines.h>
#include <mrpt/opengl/CSetOfTriangles.h>
#include <mrpt/opengl/CTexturedPlane.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "base/portable_math.h"
#include "gui/palette.h"
#include "gui/raster_levels.h"
#include "gui/wide_lines.h"
#include "logs/frames/pose_operations.h"
#include "map/report/drawn_loops.h"
#include "mapping/local_maps/scan_filter.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPoint2D;
using mrpt::math::TPoint3D;
using mrpt::math::TPose2D;
using mrpt::opengl::CSetOfLines;

/// Returns dots of one colour and size. Passes all points at once, because insertPoint() of MRPT 2.5
/// deadlocks.
mrpt::opengl::CPointCloud::Ptr dots_of(const std::vector<TPoint3D>& points, const mrpt::img::TColor& colour,
                                       float size_px) {
  auto dots = mrpt::opengl::CPointCloud::Create();
  dots->setAllPoints(points);
  dots->setColor_u8(colour);
  dots->setPointSize(size_px);
  dots->enableVariablePointSize(false);
  return dots;
}

/// Returns an empty set of lines of one colour and width.
CSetOfLines::Ptr lines_of(const mrpt::img::TColor& colour, float width) {
  auto lines = std::make_shared<WideLines>();
  lines->setColor_u8(colour);
  lines->setLineWidth(width);
  return lines;
}

/// Returns a plane at height 0 that shows the raster in its own colours, without light, and transparent where
/// the raster is transparent. Halves the raster `level` times before.
mrpt::opengl::CTexturedPlane::Ptr textured_plane(const MapRaster& whole, int level) {
  MapRaster reduced;
  for (int i = 0; i < level; ++i) reduced = half_raster(i == 0 ? whole : reduced);
  const MapRaster& raster = level > 0 ? reduced : whole;
  const auto width = static_cast<unsigned>(raster.width_px);
  const auto height = static_cast<unsigned>(raster.height_px);
  mrpt::img::CImage colour(width, height, mrpt::img::CH_RGB);
  mrpt::img::CImage opacity(width, height, mrpt::img::CH_GRAY);
  // MRPT's textures start with the bottom row, rasters with the top row.
  for (unsigned row = 0; row < height; ++row) {
    const std::uint8_t* from = raster.pixels.data() + std::size_t{4} * width * (height - 1 - row);
    auto* to = colour.ptrLine<std::uint8_t>(row);
    auto* to_opacity = opacity.ptrLine<std::uint8_t>(row);
    for (unsigned column = 0; column < width; ++column, from += 4, to += 3) {
      to[0] = from[0];
      to[1] = from[1];
      to[2] = from[2];
      to_opacity[column] = from[3];
    }
  }
  auto plane = mrpt::opengl::CTexturedPlane::Create();
  plane->assignImage(std::move(colour), std::move(opacity));
  plane->mrpt::opengl::CRenderizableShaderTexturedTriangles::enableLight(false);
  const MapRectangle corners = raster.rectangle();
  plane->setPlaneCorners(static_cast<float>(corners.x_min_m), static_cast<float>(corners.x_max_m),
                         static_cast<float>(corners.y_min_m), static_cast<float>(corners.y_max_m));
  return plane;
}

/// Returns a point or pose in the plane as a point at a height.
template <class Planar>
TPoint3D raised(const Planar& at, double z_m) {
  return {at.x, at.y, z_m};
}

/// Adds the line between two points or poses in the plane, at a height.
template <class Planar>
void join(CSetOfLines& lines, const Planar& a, const Planar& b, double z_m) {
  lines.appendLine(a.x, a.y, z_m, b.x, b.y, z_m);
}

/// Adds the line between two points or poses in the plane, with a dot at each end, to a layer.
template <class Planar>
void insert_line_with_ends(SceneLayer& layer, const Planar& a, const Planar& b, double z_m,
                           const mrpt::img::TColor& colour, float width, float dot_px) {
  auto lines = lines_of(colour, width);
  join(*lines, a, b, z_m);
  layer.insert(lines);
  layer.insert(dots_of({raised(a, z_m), raised(b, z_m)}, colour, dot_px));
}

// Height for sorting: transparent planes are drawn from far to near, and the grid map must come before the
// local maps.
constexpr float kFarBelow_m = -1000;

constexpr std::uint8_t kZoneOpacity = 110;  // out of 255
constexpr std::uint8_t kClosingOpacity = 120;

constexpr double kWallOpacity = 200;  // opacity of a cell that is surely a wall, out of 255
constexpr double kFreeOpacity = 70;   // opacity of a cell that is surely free, out of 255

/// Returns a raster with walls in the tint and free space in a paler tint. The opacity of a cell grows with
/// its certainty.
MapRaster tinted_raster(const COccupancyGridMap2D& grid, const mrpt::img::TColor& tint) {
  MapRaster raster;
  raster.width_px = static_cast<int>(grid.getSizeX());
  raster.height_px = static_cast<int>(grid.getSizeY());
  raster.resolution_m = static_cast<double>(grid.getResolution());
  raster.x_min_m = static_cast<double>(grid.getXMin());
  raster.y_max_m = static_cast<double>(grid.getYMin()) + raster.height_px * raster.resolution_m;
  raster.pixels.reserve(std::size_t{4} * grid.getSizeX() * grid.getSizeY());
  for (int y = raster.height_px - 1; y >= 0; --y) {
    const COccupancyGridMap2D::cellType* row = grid.getRow(y);
    for (int x = 0; x < raster.width_px; ++x) {
      const double free = 2 * static_cast<double>(COccupancyGridMap2D::l2p(row[x])) - 1;  // -1: wall, 1: free
      const double opaque = free < 0 ? -free * kWallOpacity : free * kFreeOpacity;
      for (const std::uint8_t channel : {tint.B, tint.G, tint.R}) raster.pixels.push_back(channel);
      raster.pixels.push_back(static_cast<std::uint8_t>(std::lround(opaque)));
    }
  }
  return raster;
}

constexpr double kShortestLine_m = 0.05;

/// Extends a line from `last` to the pose, or starts a line if `last` is empty. Skips poses closer than
/// kShortestLine_m to `last`.
void extend(CSetOfLines& lines, std::optional<TPoint3D>& last, const TPose2D& pose, double z_m) {
  const TPoint3D point = raised(pose, z_m);
  if (last && (point - *last).norm() < kShortestLine_m) return;
  if (last) lines.appendLine(*last, point);
  last = point;
}

bool starts_run(const ReplaySnapshot& snapshot, std::size_t frame) {
  return std::binary_search(snapshot.later_run_frames.begin(), snapshot.later_run_frames.end(), frame);
}

constexpr std::uint8_t kFaint = 45;
// Opacity of accepted loops, out of 255. It falls with the number of loops, so that the map stays visible.
constexpr double kClear = 140;
constexpr double kPalest = 50;
constexpr double kClearLoops = 100;  // up to this many loops keep the full opacity

constexpr double kBetweenEllipses_m = 1;
constexpr int kEllipseSides = 24;
constexpr double kRing_m = 0.75;  // radius of the ring around a hot spot
constexpr int kRingSides = 32;
constexpr float kRingWidth = 2;
constexpr float kWorstRingWidth = 4;
constexpr double kChiSquare95 = 5.991;  // 95 % point of the chi-square distribution, two degrees of freedom

// Size of the arrow that shows the robot. It points along the robot's x axis.
constexpr double kNose_m = 0.45;
constexpr double kTail_m = -0.25;
constexpr double kHalfWidth_m = 0.25;

/// Adds a search window: a rectangle around a pose, along the axes of that pose, and two lines at the limits
/// of the heading.
void add_window(CSetOfLines& lines, const TPose2D& map_T_middle, const SearchExtent& extent) {
  const std::array<TPoint2D, 4> corners{TPoint2D(extent.x_m, extent.y_m), TPoint2D(-extent.x_m, extent.y_m),
                                        TPoint2D(-extent.x_m, -extent.y_m),
                                        TPoint2D(extent.x_m, -extent.y_m)};
  const auto line = [&](const TPoint2D& a, const TPoint2D& b) { join(lines, a, b, height_m::kWindows); };
  for (std::size_t i = 0; i < corners.size(); ++i)
    line(transform(map_T_middle, corners[i]), transform(map_T_middle, corners[(i + 1) % corners.size()]));
  const double reach_m = std::max(extent.x_m, extent.y_m);
  for (const double turn_rad : {-extent.theta_rad, extent.theta_rad})
    line({map_T_middle.x, map_T_middle.y},
         transform(map_T_middle, {reach_m * portable::cos(turn_rad), reach_m * portable::sin(turn_rad)}));
}

void add_loop_window(CSetOfLines& lines, const ReplaySnapshot& snapshot, const LoopRecord& loop) {
  add_window(lines, compose(snapshot.map_T_node->at(loop.anchor), loop.anchor_T_predicted), loop.window);
}

}  // namespace

void draw_grid(SceneLayer& layer, const DrawnMap& map, int level) {
  if (map.raster.width_px == 0 || map.raster.height_px == 0) return;
  const auto plane = textured_plane(map.raster, level);
  plane->setLocalRepresentativePoint({0, 0, kFarBelow_m});
  layer.insert(plane);
}

void draw_zones(SceneLayer& layer, const DrawnMap& map, int level) {
  for (const DrawnZones& zones : map.zones) {
    const mrpt::img::TColor colour = map_edit_colour(zones.kind);
    MapRaster tinted = zones.raster;
    for (std::size_t i = 0; i + 3 < tinted.pixels.size(); i += 4) {
      if (tinted.pixels[i + 3] == 0) continue;
      tinted.pixels[i] = colour.B;
      tinted.pixels[i + 1] = colour.G;
      tinted.pixels[i + 2] = colour.R;
      tinted.pixels[i + 3] = kZoneOpacity;
    }
    const auto plane = textured_plane(tinted, level);
    const double z_m = zones.kind == MapEdit::Kind::kKeepOut ? height_m::kKeepOutZones : 0;
    plane->setPose(mrpt::math::TPose3D(0, 0, z_m, 0, 0, 0));
    layer.insert(plane);
  }
}

void draw_local_maps(SceneLayer& layer, const ReplaySnapshot& snapshot, int level) {
  for (std::size_t i = 0; i < snapshot.active_local_maps.size(); ++i)
    layer.insert(textured_plane(tinted_raster(*snapshot.active_local_maps[i].occupancy,
                                              i == 0 ? palette::kOlderMap : palette::kNewerMap),
                                level));
}

void place_local_maps(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  auto plane = layer.begin();
  for (const ActiveLocalMap& active : snapshot.active_local_maps) {
    const TPose2D pose = snapshot.map_T_node->at(active.anchor);
    (*plane)->setPose(mrpt::math::TPose3D(pose.x, pose.y, height_m::kLocalMaps, pose.phi, 0, 0));
    ++plane;
  }
}

void draw_odometry(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  if (snapshot.frames.empty()) return;
  auto lines = lines_of(palette::kOdometry, 1.5F);
  std::optional<TPoint3D> last;
  const FrameRecord& first = snapshot.frames[0];
  for (std::size_t i = 0; i < snapshot.frames.size(); ++i) {
    if (starts_run(snapshot, i)) last.reset();
    extend(*lines, last,
           compose(first.map_T_robot, between(first.odom_T_robot, snapshot.frames[i].odom_T_robot)),
           height_m::kOdometry);
  }
  layer.insert(lines);
}

void draw_trajectory(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  auto lines = lines_of(palette::kCorrected, 2.0F);
  std::optional<TPoint3D> last;
  for (std::size_t node = 0; node < snapshot.map_T_node->size(); ++node) {
    if (starts_run(snapshot, snapshot.nodes[node].frame)) last.reset();
    extend(*lines, last, (*snapshot.map_T_node)[node], height_m::kTrajectory);
  }
  if (!snapshot.frames.empty()) extend(*lines, last, snapshot.map_T_robot, height_m::kTrajectory);
  layer.insert(lines);

  std::vector<TPoint3D> unmatched;
  for (const UnmatchedStretch& stretch : snapshot.unmatched->stretches)
    for (std::size_t i = stretch.first_frame; i <= stretch.last_frame; ++i)
      unmatched.push_back(raised(map_T_frame(snapshot, i), height_m::kUnmatched));
  if (!unmatched.empty()) layer.insert(dots_of(unmatched, palette::kUnmatched, 9));
}

void draw_nodes(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  std::vector<TPoint3D> points;
  for (const TPose2D& node : *snapshot.map_T_node) points.push_back(raised(node, height_m::kNodes));
  layer.insert(dots_of(points, palette::kNode, 4));
}

void draw_constraints(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  auto lines = lines_of(palette::kConstraint, 1);
  const std::vector<TPose2D>& nodes = *snapshot.map_T_node;
  for (std::size_t i = 0; i < snapshot.local_maps.size(); ++i) {
    const LocalMapRecord& map = snapshot.local_maps[i];
    for (std::size_t node = map.first_node; node <= map.last_node && node < nodes.size(); ++node)
      if (node != map.anchor) join(*lines, nodes[map.anchor], nodes[node], height_m::kConstraints);
  }
  layer.insert(lines);
}

void draw_uncertainty(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  const std::vector<TPose2D>& nodes = *snapshot.map_T_node;
  const std::vector<std::optional<Eigen::Matrix3d>>& covariances = *snapshot.node_covariances;
  if (covariances.size() != nodes.size()) return;
  auto lines = lines_of(palette::kUncertainty, 1.5F);
  std::optional<TPoint2D> last;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    if (!covariances[node]) continue;
    const TPoint2D middle(nodes[node].x, nodes[node].y);
    if (last && (middle - *last).norm() < kBetweenEllipses_m) continue;
    last = middle;
    const Eigen::Matrix2d position = covariances[node]->topLeftCorner<2, 2>();
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes(position);
    const Eigen::Matrix2d radii_m =
        axes.eigenvectors() * (kChiSquare95 * axes.eigenvalues().cwiseMax(0)).cwiseSqrt().asDiagonal();
    const auto corner = [&](int i) {
      const double angle = 2 * M_PI * i / kEllipseSides;
      const Eigen::Vector2d offset = radii_m * Eigen::Vector2d(portable::cos(angle), portable::sin(angle));
      return TPoint2D(middle.x + offset.x(), middle.y + offset.y());
    };
    for (int i = 0; i < kEllipseSides; ++i) join(*lines, corner(i), corner(i + 1), height_m::kUncertainty);
  }
  layer.insert(lines);
}

void draw_hot_spots(SceneLayer& layer, const ReplaySnapshot& snapshot) {
  if (!snapshot.verdict) return;
  float width = kWorstRingWidth;
  std::vector<TPoint3D> suspects;
  auto to_suspects = lines_of(palette::kHotSpot, 1.5F);
  for (const HotSpot& spot : snapshot.verdict->hot_spots) {
    auto ring = lines_of(palette::kHotSpot, width);
    const auto corner = [&](int i) {
      const double angle = 2 * M_PI * i / kRingSides;
      return TPoint2D(spot.at.x + kRing_m * portable::cos(angle), spot.at.y + kRing_m * portable::sin(angle));
    };
    for (int i = 0; i < kRingSides; ++i) join(*ring, corner(i), corner(i + 1), height_m::kHotSpots);
    layer.insert(ring);
    join(*to_suspects, spot.at, spot.suspect.at, height_m::kHotSpots);
    suspects.push_back(raised(spot.suspect.at, height_m::kHotSpots));
    width = kRingWidth;
  }
  if (suspects.empty()) return;
  layer.insert(to_suspects);
  layer.insert(dots_of(suspects, palette::kHotSpot, 9));
}

const HotSpot* hot_spot_at(const ReplaySnapshot& snapshot, const TPoint2D& place) {
  const HotSpot* nearest = nullptr;
  if (!snapshot.verdict) return nearest;
  double nearest_m = kRing_m;
  for (const HotSpot& spot : snapshot.verdict->hot_spots) {
    const double away_m = (spot.at - place).norm();
    if (away_m > nearest_m) continue;
    nearest = &spot;
    nearest_m = away_m;
  }
  return nearest;
}

std::string hot_spot_hint(const HotSpot& spot) {
  std::string text = hot_spot_text(spot);
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text + ".\nTry: " + advice_text(spot) + '.';
}

void draw_loops(SceneLayer& layer, const ReplaySnapshot& snapshot, const LoopStyle& style) {
  using Key = std::tuple<bool, std::uint8_t, std::uint8_t, std::uint8_t>;
  std::map<Key, CSetOfLines::Ptr> by_colour;
  const std::vector<std::size_t> drawn = drawn_loops(*snapshot.loops);
  const auto of_mapping = std::count_if(drawn.begin(), drawn.end(), [&](std::size_t i) {
    const LoopRecord& loop = (*snapshot.loops)[i];
    return loop.state == LoopState::kAccepted && !loop.in_final_search;
  });
  const double crowd = std::max(1.0, static_cast<double>(of_mapping) / kClearLoops);
  const auto clear = static_cast<std::uint8_t>(std::max(kPalest, kClear / std::sqrt(crowd)));
  for (const std::size_t index : drawn) {
    const LoopRecord& loop = (*snapshot.loops)[index];
    const bool was_no_loop = loop.state == LoopState::kRejected && !is_outlier(loop);
    if (was_no_loop && !style.rejected) continue;
    mrpt::img::TColor colour = loop_colour(loop, snapshot, style);
    const bool faint = loop.in_final_search || was_no_loop;
    colour.A = faint ? kFaint : clear;
    CSetOfLines::Ptr& lines = by_colour[{!faint, colour.R, colour.G, colour.B}];
    if (!lines) lines = lines_of(colour, faint ? 1.0F : 1.5F);
    join(*lines, snapshot.map_T_node->at(loop.reference), snapshot.map_T_node->at(loop.node),
         height_m::kLoops);
  }
  for (const auto& [key, lines] : by_colour) layer.insert(lines);
}

void draw_chosen_loop(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t index) {
  const LoopRecord& loop = (*snapshot.loops)[index];
  insert_line_with_ends(layer, snapshot.map_T_node->at(loop.reference), snapshot.map_T_node->at(loop.node),
                        height_m::kChosenLoop, palette::kChosen, 4, 10);
  auto window = lines_of(palette::kWindow, 1.5F);
  add_loop_window(*window, snapshot, loop);
  layer.insert(window);
}

void draw_robot(SceneLayer& layer, const TPose2D& map_T_robot) {
  auto triangles = mrpt::opengl::CSetOfTriangles::Create();
  triangles->enableLight(false);
  mrpt::opengl::TTriangle arrow(raised(transform(map_T_robot, {kNose_m, 0}), height_m::kRobot),
                                raised(transform(map_T_robot, {kTail_m, kHalfWidth_m}), height_m::kRobot),
                                raised(transform(map_T_robot, {kTail_m, -kHalfWidth_m}), height_m::kRobot));
  arrow.setColor(mrpt::img::TColor(palette::kRobot));
  triangles->insertTriangle(arrow);
  layer.insert(triangles);
}

void draw_scan(SceneLayer& layer, const Frame& frame, const TPose2D& map_T_robot) {
  ScanFilterOptions all;
  all.spacing_m = 0;
  all.max_range_m = static_cast<double>(frame.scan.max_range_m);
  for (const CompanionScan& companion : frame.companions)
    all.max_range_m = std::max(all.max_range_m, static_cast<double>(companion.scan.max_range_m));
  std::vector<TPoint3D> points;
  for (const mrpt::math::TPoint2Df& point : matching_points(frame, all).points)
    points.push_back(raised(transform(map_T_robot, point), height_m::kScan));
  if (!points.empty()) layer.insert(dots_of(points, palette::kScan, 3));  // MRPT cannot draw zero points
}

void draw_windows(SceneLayer& layer, const ReplaySnapshot& snapshot, std::size_t frame) {
  auto lines = lines_of(palette::kWindow, 1.5F);
  if (frame > 0) {  // the front end searches around the pose that odometry predicts
    const FrameRecord& record = snapshot.frames[frame];
    const TPose2D motion = between(snapshot.frames[frame - 1].odom_T_robot, record.odom_T_robot);
    add_window(*lines, compose(map_T_frame(snapshot, frame - 1), motion), record.window);
  }
  for (const LoopRecord& loop : *snapshot.loops)
    if (loop.frame == frame && !loop.in_final_search) add_loop_window(*lines, snapshot, loop);
  layer.insert(lines);
}

void draw_measure(SceneLayer& layer, const Measure& measure) {
  insert_line_with_ends(layer, measure.from, measure.to, height_m::kMeasure, palette::kMeasure, 2, 8);
}

void draw_draft(SceneLayer& layer, const MapDraft& draft) {
  if (draft.points.empty()) return;  // MRPT cannot draw zero points
  std::vector<TPoint3D> corners;
  auto lines = lines_of(draft.colour, 2.5F);
  for (std::size_t i = 0; i < draft.points.size(); ++i) {
    corners.push_back(raised(draft.points[i], height_m::kDraft));
    if (i > 0) join(*lines, draft.points[i - 1], draft.points[i], height_m::kDraft);
  }
  layer.insert(lines);
  layer.insert(dots_of(corners, draft.colour, 8));
  if (!draft.closed || draft.points.size() < 3) return;
  mrpt::img::TColor pale = draft.colour;
  pale.A = kClosingOpacity;
  auto closing = lines_of(pale, 1.5F);
  join(*closing, draft.points.back(), draft.points.front(), height_m::kDraft);
  layer.insert(closing);
}

}  // namespace psi_slam
