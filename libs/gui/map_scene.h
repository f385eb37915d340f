// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/img/CImage.h>
#include <mrpt/math/TPoint2D.h>
#include <mrpt/opengl/COpenGLScene.h>
#include <mrpt/opengl/CSetOfObjects.h>

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <vector>

#include "gui/map_painter.h"
#include "gui/replay_snapshot.h"

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
  kUncertainty,
  kZones,
  kHotSpots,
};
inline constexpr std::size_t kMapLayers = 13;

/// Name of a layer for menus, such as "Grid map".
const char* name_of(MapLayer layer);
/// True if the layer is visible by default.
bool shown_at_first(MapLayer layer);

struct LoopStyle {
  enum class Colour { kMatcher, kResidual };
  Colour colour = Colour::kMatcher;
  bool rejected = false;  ///< whether to draw rejected loops other than outlier loops

  bool operator==(const LoopStyle& other) const {
    return colour == other.colour && rejected == other.rejected;
  }
};

/// Residuals of this size and larger ones have the last colour of the scale.
inline constexpr double kWorstResidual_m = 0.25;

/// A line with which a person measures a distance, in the map's frame.
struct Measure {
  mrpt::math::TPoint2D from;
  mrpt::math::TPoint2D to;
  double distance_m() const { return (to - from).norm(); }
};

/// A line or polygon that a person is drawing, in the map's frame.
struct MapDraft {
  std::vector<mrpt::math::TPoint2D> points;
  bool closed = false;  ///< a polygon
  mrpt::img::TColor colour;
};

/// A run as an MRPT scene, for windows, reports and tests. Has one layer for each kind of object, and redraws
/// only the layers whose data has changed.
///
/// The layers are millimetres apart in height, which OpenGL cannot always resolve from far above. So maps,
/// zones, lines and marks have a viewport each, and the viewports are drawn on top of each other. All
/// viewports use the camera of the first viewport, "main".
class MapScene {
 public:
  MapScene();

  /// The scene, which is always the same object.
  const mrpt::opengl::COpenGLScene::Ptr& scene() const { return scene_; }
  /// Sets the range of distances from the eye, in metres, within which objects are drawn.
  void set_clip_distances(double nearest_m, double farthest_m);
  /// Sets the width of the ground that a pixel of the screen shows, in metres. The next show() draws maps
  /// with pixels of at least this width, so that thin walls stay solid lines. By default, shows every cell.
  void set_ground_pixel(double pixel_m) { ground_pixel_m_ = pixel_m; }

  /// Brings all visible layers up to date. Shows the scan `frame`, or the newest scan if `frame` is empty.
  /// Returns true if anything has changed.
  bool show(const std::shared_ptr<const ReplaySnapshot>& snapshot, const std::shared_ptr<const DrawnMap>& map,
            std::optional<std::size_t> frame = {});

  void set_visible(MapLayer layer, bool visible);
  bool visible(MapLayer layer) const { return this->layer(layer).isVisible(); }
  void set_loop_style(const LoopStyle& style) { loop_style_ = style; }
  const LoopStyle& loop_style() const { return loop_style_; }
  /// Selects the loop to highlight, by its index in ReplaySnapshot::loops; empty selects none.
  void choose_loop(std::optional<std::size_t> loop) { chosen_loop_ = loop; }
  void set_measure(const std::optional<Measure>& measure);
  /// Shows a draft; nothing if it has no points.
  void set_draft(const MapDraft& draft);

  /// Multiplies the sizes of lines and points by a factor, for desktops that are scaled. Draws the measure
  /// and the draft again at once, and the layers at the next show().
  void set_pixel_scale(float scale);
  /// Shows an image in the lower left corner at its own size; shows nothing if the image is empty.
  void set_legend(mrpt::img::CImage picture, int margin_px);

  /// The objects of a layer.
  const mrpt::opengl::CSetOfObjects& layer(MapLayer layer) const {
    return *layers_[static_cast<std::size_t>(layer)];
  }

 private:
  struct Shown {
    std::shared_ptr<const ReplaySnapshot> snapshot;
    std::shared_ptr<const DrawnMap> map;
    std::optional<std::size_t> frame;
    LoopStyle loop_style;
    std::optional<std::size_t> chosen_loop;
    int grid_level = 0;
    int local_map_level = 0;
  };
  mrpt::opengl::CSetOfObjects& of(MapLayer layer) { return *layers_[static_cast<std::size_t>(layer)]; }
  template <class Draw>
  void fill(mrpt::opengl::CSetOfObjects& layer, const Draw& draw) const;
  template <class Draw, class... Matter>
  void redraw(MapLayer layer, const Draw& draw, const Matter&... matter);
  void draw_hand_lines();
  bool show_maps(const std::shared_ptr<const DrawnMap>& map);
  bool show_local_maps(const ReplaySnapshot& snapshot, bool poses_changed);
  bool show_graph(const ReplaySnapshot& snapshot, bool poses_changed);
  void show_robot(const ReplaySnapshot& snapshot, std::optional<std::size_t> frame);

  mrpt::opengl::COpenGLScene::Ptr scene_ = mrpt::opengl::COpenGLScene::Create();
  std::array<mrpt::opengl::CSetOfObjects::Ptr, kMapLayers> layers_;
  mrpt::opengl::CSetOfObjects::Ptr chosen_layer_ = mrpt::opengl::CSetOfObjects::Create();
  mrpt::opengl::CSetOfObjects::Ptr measure_layer_ = mrpt::opengl::CSetOfObjects::Create();
  mrpt::opengl::CSetOfObjects::Ptr draft_layer_ = mrpt::opengl::CSetOfObjects::Create();
  std::optional<Measure> measure_;
  MapDraft draft_;
  LoopStyle loop_style_;
  std::optional<std::size_t> chosen_loop_;
  float pixel_scale_ = 1;
  double ground_pixel_m_ = 0;
  Shown shown_;
};

}  // namespace psi_slam
