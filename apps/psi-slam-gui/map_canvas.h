// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/gui/CWxGLCanvasBase.h>
#include <wx/image.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "gui/map_camera.h"
#include "gui/palette.h"

namespace psi_slam {

/// The map view: the MRPT scene of the run in a window. The left button moves the map, or draws a line while
/// measuring. The right button rotates and tilts the map. The wheel zooms towards the pointer.
class MapCanvas : public mrpt::gui::CWxGLCanvasBase {
 public:
  explicit MapCanvas(wxWindow* parent);

  /// Functions that the canvas calls when the user clicks, measures, or starts or stops following the robot.
  struct Callbacks {
    std::function<void(const mrpt::math::TPoint2D&)> clicked = [](const mrpt::math::TPoint2D&) {};
    /// Called after a double click or a click with the right button while pointing.
    std::function<void()> closed = [] {};
    std::function<void(const Measure&)> measured = [](const Measure&) {};
    std::function<void(bool)> followed = [](bool) {};
    /// Called with an error message if OpenGL cannot draw: once for the view, and once for each picture.
    std::function<void(const std::string&)> failed = [](const std::string&) {};
  };
  Callbacks on;

  /// Passes typed keys on to the window. MRPT's canvas would take them all for its own commands.
  bool ProcessEvent(wxEvent& event) override;

  MapScene& map_scene() { return map_scene_; }

  /// Shows the run at scan `frame`, or at the newest scan if `frame` is empty. Keeps the whole map in view
  /// until the user moves the map.
  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot, const std::shared_ptr<const DrawnMap>& map,
            std::optional<std::size_t> frame);

  /// Redraws after a change of layers or of the style of loops.
  void restyle();
  /// Legend of the colours of loops; without entries if no loop is shown.
  const LoopLegend& legend() const { return legend_; }

  /// Shows the whole map from above, and keeps it in view while it grows.
  void show_all();
  /// Looks straight down, keeping target and distance.
  void look_from_above();
  void set_follow(bool follow);
  bool follows() const { return follow_; }
  void set_measuring(bool measuring);
  bool measuring() const { return measuring_; }
  /// While pointing, a click with the left button calls on.clicked instead of moving the map.
  void set_pointing(bool pointing);
  bool pointing() const { return pointing_; }
  /// Shows a draft that ends at the pointer; nothing if it has no points.
  void show_draft(MapDraft draft);
  const std::optional<Measure>& measure() const { return measure_; }
  void look_at(const mrpt::math::TPoint2D& place, double distance_m);

  MapCamera camera() const;

  /// Draws the map again, then calls `taken` with the picture. Does not call `taken` if OpenGL cannot draw.
  void take_picture(std::function<void(const wxImage&)> taken);

 private:
  double renderCanvas(int width, int height) override;
  void OnPostRender() override;
  void OnRenderError(const wxString& text) override;

  void bind_mouse();
  void press(wxMouseEvent& event);
  void move(wxMouseEvent& event);
  void show_hint(const std::optional<mrpt::math::TPoint2D>& place);
  void release(const wxMouseEvent& event);
  void zoom(wxMouseEvent& event);
  void key(wxKeyEvent& event);
  mrpt::img::TImageSize picture_size() const { return {GetClientSize().x, GetClientSize().y}; }
  std::optional<mrpt::math::TPoint2D> ground(const wxMouseEvent& event) const;
  void set_camera(const MapCamera& camera);
  void set_target(const mrpt::math::TPoint2D& target);
  void zoom_by(double factor);
  void move_target(const mrpt::math::TPoint2D& by);
  void fit();
  void show_legend();

  MapScene map_scene_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::shared_ptr<const DrawnMap> map_;
  LoopLegend legend_;
  double legend_scale_ = 0;
  std::optional<mrpt::math::TPoint2D> robot_;
  bool fit_ = true;
  bool follow_ = false;
  bool measuring_ = false;
  bool pointing_ = false;
  MapDraft draft_;
  std::optional<Measure> measure_;
  enum class Drag { kNone, kMove, kTurn, kMeasure };
  Drag drag_ = Drag::kNone;
  wxPoint dragged_from_;
  wxPoint pressed_at_;
  std::function<void(const wxImage&)> picture_taken_;
  bool reported_failure_ = false;
};

}  // namespace psi_slam
