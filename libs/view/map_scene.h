// SPDX-License-Identifier: BSD-3-Clause
// A run as one of MRPT's scenes: for windows, reports and tests. It holds a layer for each thing to be seen,
// and redraws those alone whose matter has changed since it was shown last.
//
// Layers lie centimetres above each other, which OpenGL cannot always tell apart from far above; so the maps,
// the lines on them and the marks on those are viewports, drawn one over the other whatever their depths. All
// follow the camera of the first, "main".
#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "replay/map_painter.h"
#include "replay/replay_snapshot.h"

namespace psi_slam {

enum class MapLayer {
  kGrid,
  kLocalMaps,
  kOdometry,
  kTrajectory,
  kConstraints,
  kNodes,
  kLoops,
  kScan,
  kRobot,
  kWindows,
};
inline constexpr std::size_t kMapLayers = 10;

/// For menus: "Gridmap", ...
const char* name_of(MapLayer layer);
/// What is shown unless somebody says otherwise.
bool shown_at_first(MapLayer layer);

struct LoopStyle {
  enum class Colour { kMatcher, kResidual };
  Colour colour = Colour::kMatcher;
  bool refused = false;  ///< those that never became a constraint are shown, too

  bool operator==(const LoopStyle& other) const { return colour == other.colour && refused == other.refused; }
};

/// The residual that is as red as can be.
inline constexpr double kWorstResidual_m = 0.25;

/// A distance that a person measures, in the map.
struct Measure {
  mrpt::math::TPoint2D from;
  mrpt::math::TPoint2D to;
  double distance_m() const { return (to - from).norm(); }
};

class MapScene {
 public:
  MapScene();

  /// The scene itself stays the same object.
  const mrpt::opengl::COpenGLScene::Ptr& scene() const { return scene_; }
  /// Nothing nearer to the eye is drawn, and nothing farther.
  void set_clip_distances(double nearest_m, double farthest_m);

  /// Brings all layers up to date. `frame` is the scan to show instead of the newest. True when anything has
  /// changed.
  bool show(const std::shared_ptr<const ReplaySnapshot>& snapshot, const std::shared_ptr<const DrawnMap>& map,
            std::optional<std::size_t> frame = {});

  void set_visible(MapLayer layer, bool visible);
  bool visible(MapLayer layer) const;
  void set_loop_style(const LoopStyle& style) { loop_style_ = style; }
  const LoopStyle& loop_style() const { return loop_style_; }
  /// A loop to stand out, by its index in ReplaySnapshot::loops.
  void choose_loop(std::optional<std::size_t> loop) { chosen_loop_ = loop; }
  void set_measure(const std::optional<Measure>& measure);

  /// Pixels of the screen to one of a desktop that is not scaled: lines and points are so many times as
  /// large.
  void set_pixel_scale(float scale);
  /// A picture in the lower left corner, pixel for pixel, this far from the edges; an empty one: none.
  void set_legend(mrpt::img::CImage picture, int margin_px);

  /// The objects of a layer; for those who want to know what is drawn.
  const mrpt::opengl::CSetOfObjects& layer(MapLayer layer) const;

 private:
  struct Shown {
    std::shared_ptr<const ReplaySnapshot> snapshot;
    std::shared_ptr<const DrawnMap> map;
    std::optional<std::size_t> frame;
    LoopStyle loop_style;
    std::optional<std::size_t> chosen_loop;
  };
  using Fill = std::function<void(mrpt::opengl::CSetOfObjects&)>;
  mrpt::opengl::CSetOfObjects& of(MapLayer layer);
  void fill(mrpt::opengl::CSetOfObjects& layer, const Fill& draw) const;
  bool show_graph(const ReplaySnapshot& snapshot, bool poses_changed);
  bool show_robot(const ReplaySnapshot& snapshot, std::optional<std::size_t> frame, bool changed);

  mrpt::opengl::COpenGLScene::Ptr scene_ = mrpt::opengl::COpenGLScene::Create();
  std::array<mrpt::opengl::CSetOfObjects::Ptr, kMapLayers> layers_;
  mrpt::opengl::CSetOfObjects::Ptr chosen_layer_ = mrpt::opengl::CSetOfObjects::Create();
  mrpt::opengl::CSetOfObjects::Ptr measure_layer_ = mrpt::opengl::CSetOfObjects::Create();
  LoopStyle loop_style_;
  std::optional<std::size_t> chosen_loop_;
  float pixel_scale_ = 1;
  Shown shown_;
};

}  // namespace psi_slam
