// SPDX-License-Identifier: BSD-3-Clause
// The map view: MRPT's OpenGL scene of the run in a window. Left button: move the map. Right button: turn and
// tilt it. Wheel: zoom to where the pointer is. While measuring, the left button draws a line.
#pragma once

#include <mrpt/gui/CWxGLCanvasBase.h>
#include <wx/image.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "view/loop_legend.h"
#include "view/map_camera.h"
#include "view/map_scene.h"

namespace psi_slam {

class MapCanvas : public mrpt::gui::CWxGLCanvasBase {
 public:
  explicit MapCanvas(wxWindow* parent);

  MapScene& map_scene() { return map_scene_; }

  /// Shows the run as it is; the map is kept in sight until the user moves it.
  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot, const std::shared_ptr<const DrawnMap>& map,
            std::optional<std::size_t> frame);

  /// What is to be seen of the layers and the loops has changed.
  void restyle();
  /// Of the loops' colours, as it is on show; without entries where it is not.
  const LoopLegend& legend() const { return legend_; }

  /// All of the map, from above, from now on.
  void show_all();
  /// From above, at this place and distance.
  void look_from_above();
  void set_follow(bool follow);
  bool follows() const { return follow_; }
  void set_measuring(bool measuring);
  bool measuring() const { return measuring_; }
  /// A click with the left button points at a place instead of moving the map.
  void set_pointing(bool pointing);
  bool pointing() const { return pointing_; }
  /// A place pointed at before, with a line from it to the pointer.
  void show_pointed(const std::optional<mrpt::math::TPoint2D>& place);
  void on_pointed(std::function<void(const mrpt::math::TPoint2D&)> told) { told_pointed_ = std::move(told); }
  const std::optional<Measure>& measure() const { return measure_; }
  /// Looks at a place of the map.
  void look_at(const mrpt::math::TPoint2D& place, double distance_m);

  MapCamera camera() const;
  PictureSize picture_size() const;

  /// Draws the map once more and hands over what was drawn.
  void take_picture(std::function<void(const wxImage&)> taken);

  void on_measured(std::function<void(const Measure&)> told) { told_measure_ = std::move(told); }
  void on_followed(std::function<void(bool)> told) { told_follow_ = std::move(told); }
  /// A sentence of OpenGL that cannot draw, told once.
  void on_failure(std::function<void(const std::string&)> told) { told_failure_ = std::move(told); }

 private:
  double renderCanvas(int width, int height) override;
  void OnPostRender() override;
  void OnRenderError(const wxString& text) override;

  void bind_mouse();
  void press(wxMouseEvent& event, bool left);
  void move(wxMouseEvent& event);
  void release();
  void zoom(wxMouseEvent& event);
  void key(wxKeyEvent& event);
  std::optional<mrpt::math::TPoint2D> ground(const wxMouseEvent& event) const;
  void set_camera(const MapCamera& camera);
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
  std::optional<mrpt::math::TPoint2D> pointed_;
  std::optional<Measure> measure_;
  enum class Drag { kNone, kMove, kTurn, kMeasure };
  Drag drag_ = Drag::kNone;
  wxPoint dragged_from_;
  std::function<void(const wxImage&)> picture_taken_;
  bool told_of_failure_ = false;
  std::function<void(const Measure&)> told_measure_;
  std::function<void(const mrpt::math::TPoint2D&)> told_pointed_;
  std::function<void(bool)> told_follow_;
  std::function<void(const std::string&)> told_failure_;
};

}  // namespace psi_slam
