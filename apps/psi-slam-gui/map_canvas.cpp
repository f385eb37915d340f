// SPDX-License-Identifier: BSD-3-Clause
#include "map_canvas.h"

#include <GL/gl.h>
#include <mrpt/gui/WxUtils.h>
#include <wx/dcmemory.h>
#include <wx/graphics.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <utility>

#include "base/portable_math.h"
#include "gui/layers.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr double kZoomPerNotch = 1.25;
constexpr double kNearest_m = 1;
constexpr double kFarthest_m = 5000;
constexpr double kTurnPerPixel_deg = 0.4;
constexpr double kLowest_deg = 10;       // least elevation of the camera
constexpr double kFromAbove_deg = 89.9;  // at 90, MRPT's camera has no upward direction
constexpr double kFollowDistance_m = 25;
constexpr int kLegendMargin = 10;
constexpr int kClickReach = 4;  // a button that moves further while it is down drags, in pixels
// Clipping distances, as multiples of the distance from the camera to its target.
constexpr double kNearShare = 0.2;
constexpr double kFarShare = 8;

/// Draws a legend into the upper left corner: its title, and a coloured stroke with a name for each entry.
/// Returns the size of the legend with a margin. All sizes are pixels at 100 % scaling.
wxSize draw_legend(wxGraphicsContext& context, const LoopLegend& legend, const wxFont& font) {
  constexpr double kMargin = 7;
  constexpr double kStroke = 18;
  constexpr int kStrokeWidth = 3;
  constexpr double kGap = 6;
  double right = 0;
  double y = kMargin;
  const auto draw_line = [&](const wxString& text, const wxFont& line_font, double x) {
    double width = 0;
    double height = 0;
    context.SetFont(line_font, wxColour(40, 44, 52));
    context.GetTextExtent(text, &width, &height);
    context.DrawText(text, x, y);
    right = std::max(right, x + width);
    y += height;
  };
  draw_line(text_of(legend.title), font.Bold(), kMargin);
  for (const LoopLegend::Entry& entry : legend.entries) {
    const double top = y;
    draw_line(text_of(entry.name), font, kMargin + kStroke + kGap);
    context.SetPen(wxPen(colour_of(entry.colour), kStrokeWidth));
    context.StrokeLine(kMargin, (top + y) / 2, kMargin + kStroke, (top + y) / 2);
  }
  return {static_cast<int>(std::ceil(right + kMargin)), static_cast<int>(std::ceil(y + kMargin))};
}

/// Picture of the legend in a box, with the window's font and scaling. Empty without entries.
mrpt::img::CImage legend_picture(const LoopLegend& legend, const wxWindow& window) {
  if (legend.entries.empty()) return {};
  const double scale = window.GetContentScaleFactor();
  wxSize size(1, 1);
  wxBitmap bitmap;
  for (const double zoom : {1.0, scale}) {  // the first pass only measures the size
    bitmap.Create(size * zoom, 24);
    wxMemoryDC dc(bitmap);
    dc.SetBackground(*wxWHITE_BRUSH);
    dc.Clear();
    const std::unique_ptr<wxGraphicsContext> context(wxGraphicsContext::Create(dc));
    context->Scale(zoom, zoom);
    context->SetPen(wxPen(wxColour(190, 194, 200)));
    context->DrawRectangle(0, 0, size.x - 1, size.y - 1);
    size = draw_legend(*context, legend, window.GetFont().Smaller());
  }
  return *mrpt::gui::wxImage2MRPTImagePtr(bitmap.ConvertToImage());
}

}  // namespace

MapCanvas::MapCanvas(wxWindow* parent) : CWxGLCanvasBase(parent, wxID_ANY) {
  SetName("map");
  setOpenGLSceneRef(map_scene_.scene());
  setMinimumZoom(static_cast<float>(kNearest_m));
  setMaximumZoom(static_cast<float>(kFarthest_m));
  set_camera(MapCamera{});
  bind_mouse();
}

void MapCanvas::bind_mouse() {
  for (const auto& down : {wxEVT_LEFT_DOWN, wxEVT_RIGHT_DOWN, wxEVT_MIDDLE_DOWN})
    Bind(down, [this](wxMouseEvent& event) { press(event); });
  for (const auto& up : {wxEVT_LEFT_UP, wxEVT_RIGHT_UP, wxEVT_MIDDLE_UP})
    Bind(up, [this](wxMouseEvent& event) { release(event); });
  Bind(wxEVT_LEFT_DCLICK, [this](wxMouseEvent& event) { pointing_ ? on.closed() : event.Skip(); });
  Bind(wxEVT_MOTION, [this](wxMouseEvent& event) { move(event); });
  Bind(wxEVT_MOUSEWHEEL, [this](wxMouseEvent& event) { zoom(event); });
  Bind(wxEVT_MOUSE_CAPTURE_LOST, [this](wxMouseCaptureLostEvent&) { drag_ = Drag::kNone; });
  Bind(wxEVT_KEY_DOWN, [this](wxKeyEvent& event) { key(event); });
}

bool MapCanvas::ProcessEvent(wxEvent& event) {
  const wxEventType type = event.GetEventType();
  if (type == wxEVT_CHAR || type == wxEVT_CHAR_HOOK) return TryAfter(event);
  return CWxGLCanvasBase::ProcessEvent(event);
}

void MapCanvas::show(const std::shared_ptr<const ReplaySnapshot>& snapshot,
                     const std::shared_ptr<const DrawnMap>& map, std::optional<std::size_t> frame) {
  map_scene_.set_pixel_scale(static_cast<float>(GetContentScaleFactor()));
  map_scene_.set_ground_pixel(ground_pixel_m(camera(), picture_size()));
  const bool changed = map_scene_.show(snapshot, map, frame);
  snapshot_ = snapshot;
  if (!changed) return;
  show_legend();
  map_ = map;
  robot_.reset();
  if (!snapshot->frames.empty()) {
    const std::size_t last = snapshot->frames.size() - 1;
    robot_ = mrpt::math::TPoint2D(map_T_frame(*snapshot, std::min(frame.value_or(last), last)));
  }
  if (follow_ && robot_)
    set_target(*robot_);
  else if (fit_)
    fit();
  Refresh(false);
}

void MapCanvas::restyle() {
  show_legend();
  Refresh(false);
}

void MapCanvas::show_legend() {
  LoopLegend legend;
  if (snapshot_ && map_scene_.visible(MapLayer::kLoops))
    legend = loop_legend(*snapshot_, map_scene_.loop_style());
  const double scale = GetContentScaleFactor();
  if (legend == legend_ && scale == legend_scale_) return;
  legend_ = std::move(legend);
  legend_scale_ = scale;
  map_scene_.set_legend(legend_picture(legend_, *this), static_cast<int>(FromDIP(kLegendMargin) * scale));
}

void MapCanvas::show_all() {
  set_follow(false);
  fit_ = true;
  fit();
}

void MapCanvas::fit() {
  if (!map_ || map_->raster.width_px == 0) {
    if (robot_) set_target(*robot_);
    return;
  }
  set_camera(camera_above(map_->raster.rectangle(), picture_size()));
}

void MapCanvas::look_from_above() {
  MapCamera camera = this->camera();
  camera.azimuth_deg = -90;
  camera.elevation_deg = 90;
  set_camera(camera);
}

void MapCanvas::set_follow(bool follow) {
  if (follow == follow_) return;
  follow_ = follow;
  fit_ = false;
  if (follow) {
    MapCamera camera = this->camera();
    if (robot_) camera.target = *robot_;
    camera.distance_m = std::min(camera.distance_m, kFollowDistance_m);
    set_camera(camera);
  }
  on.followed(follow);
}

void MapCanvas::set_measuring(bool measuring) {
  measuring_ = measuring;
  if (!measuring) measure_.reset();
  map_scene_.set_measure(measure_);
  SetCursor(wxCursor(measuring ? wxCURSOR_CROSS : wxCURSOR_ARROW));
  Refresh(false);
}

void MapCanvas::set_pointing(bool pointing) {
  pointing_ = pointing;
  SetCursor(wxCursor(pointing ? wxCURSOR_BULLSEYE : measuring_ ? wxCURSOR_CROSS : wxCURSOR_ARROW));
}

void MapCanvas::show_draft(MapDraft draft) {
  draft_ = std::move(draft);
  map_scene_.set_draft(draft_);
  Refresh(false);
}

void MapCanvas::look_at(const mrpt::math::TPoint2D& place, double distance_m) {
  set_follow(false);
  fit_ = false;
  MapCamera camera = this->camera();
  camera.target = place;
  camera.distance_m = distance_m;
  set_camera(camera);
}

MapCamera MapCanvas::camera() const {
  return {{static_cast<double>(getCameraPointingX()), static_cast<double>(getCameraPointingY())},
          static_cast<double>(getZoomDistance()),
          static_cast<double>(getAzimuthDegrees()),
          static_cast<double>(getElevationDegrees()),
          static_cast<double>(cameraFOV())};
}

void MapCanvas::set_target(const mrpt::math::TPoint2D& target) {
  setCameraPointing(static_cast<float>(target.x), static_cast<float>(target.y), 0);
  Refresh(false);
}

void MapCanvas::set_camera(const MapCamera& camera) {
  set_target(camera.target);
  setZoomDistance(static_cast<float>(std::clamp(camera.distance_m, kNearest_m, kFarthest_m)));
  setAzimuthDegrees(static_cast<float>(camera.azimuth_deg));
  setElevationDegrees(static_cast<float>(std::clamp(camera.elevation_deg, kLowest_deg, kFromAbove_deg)));
  setCameraFOV(static_cast<float>(camera.field_of_view_deg));
  const double distance_m = static_cast<double>(getZoomDistance());
  map_scene_.set_clip_distances(distance_m * kNearShare, distance_m * kFarShare);
}

std::optional<mrpt::math::TPoint2D> MapCanvas::ground(const wxMouseEvent& event) const {
  return ground_at(camera(), picture_size(), event.GetX(), event.GetY());
}

void MapCanvas::press(wxMouseEvent& event) {
  const bool left = event.LeftDown();
  SetFocus();
  if (left && pointing_) {
    if (const auto place = ground(event)) on.clicked(*place);
    return;
  }
  dragged_from_ = pressed_at_ = event.GetPosition();
  drag_ = left ? Drag::kMove : Drag::kTurn;
  if (left && measuring_) {
    drag_ = Drag::kMeasure;
    if (const auto place = ground(event)) measure_ = Measure{*place, *place};
  }
  if (!HasCapture()) CaptureMouse();
}

void MapCanvas::release(const wxMouseEvent& event) {
  drag_ = Drag::kNone;
  if (HasCapture()) ReleaseMouse();
  const wxPoint moved = event.GetPosition() - pressed_at_;
  if (pointing_ && event.RightUp() && std::abs(moved.x) + std::abs(moved.y) <= kClickReach) on.closed();
}

void MapCanvas::move(wxMouseEvent& event) {
  const std::optional<mrpt::math::TPoint2D> place = ground(event);
  if (!draft_.points.empty() && place) {
    MapDraft with_pointer = draft_;
    with_pointer.points.push_back(*place);
    map_scene_.set_draft(with_pointer);
    Refresh(false);
  }
  if (drag_ == Drag::kNone) return show_hint(place);
  MapCamera camera = this->camera();
  const wxPoint from = dragged_from_;
  if (drag_ == Drag::kMeasure && place && measure_) {
    measure_->to = *place;
    map_scene_.set_measure(measure_);
    on.measured(*measure_);
  } else if (drag_ == Drag::kMove) {
    const auto before = ground_at(camera, picture_size(), from.x, from.y);
    if (before && place) move_target(*before - *place);
  } else if (drag_ == Drag::kTurn) {
    fit_ = false;
    camera.azimuth_deg -= kTurnPerPixel_deg * (event.GetX() - from.x);
    camera.elevation_deg += kTurnPerPixel_deg * (event.GetY() - from.y);
    set_camera(camera);
  }
  dragged_from_ = event.GetPosition();
  Refresh(false);
}

/// Shows what the verdict says about the hot spot under the pointer.
void MapCanvas::show_hint(const std::optional<mrpt::math::TPoint2D>& place) {
  const HotSpot* const spot = place && snapshot_ && map_scene_.visible(MapLayer::kHotSpots)
                                  ? hot_spot_at(*snapshot_, *place)
                                  : nullptr;
  const wxString hint = spot != nullptr ? text_of(hot_spot_hint(*spot)) : wxString();
  if (hint == GetToolTipText()) return;
  hint.empty() ? UnsetToolTip() : SetToolTip(hint);
}

void MapCanvas::move_target(const mrpt::math::TPoint2D& by) {
  set_follow(false);
  fit_ = false;
  set_target(camera().target + by);
}

void MapCanvas::zoom_by(double factor) {
  fit_ = false;
  MapCamera camera = this->camera();
  camera.distance_m /= factor;
  set_camera(camera);
}

void MapCanvas::zoom(wxMouseEvent& event) {
  const double notches = static_cast<double>(event.GetWheelRotation()) / std::max(1, event.GetWheelDelta());
  const auto before = ground(event);
  zoom_by(portable::pow(kZoomPerNotch, notches));
  const auto after = ground(event);
  if (!follow_ && before && after) move_target(*before - *after);
}

void MapCanvas::key(wxKeyEvent& event) {
  const double step = camera().distance_m / 20;
  const int code = event.GetKeyCode();
  if (code == WXK_LEFT) return move_target({-step, 0});
  if (code == WXK_RIGHT) return move_target({step, 0});
  if (code == WXK_UP) return move_target({0, step});
  if (code == WXK_DOWN) return move_target({0, -step});
  if (code == '+' || code == '=' || code == WXK_NUMPAD_ADD) return zoom_by(kZoomPerNotch);
  if (code == '-' || code == WXK_NUMPAD_SUBTRACT) return zoom_by(1 / kZoomPerNotch);
  event.Skip();
}

void MapCanvas::take_picture(std::function<void(const wxImage&)> taken) {
  picture_taken_ = std::move(taken);
  reported_failure_ = false;  // reports a failure of this picture even if one was reported before
  Refresh(false);
}

/// Renders in pixels of the screen, which are smaller than wxWidgets' pixels on a scaled desktop.
double MapCanvas::renderCanvas(int, int) {
  const wxSize size = GetClientSize() * GetContentScaleFactor();
  return CWxGLCanvasBase::renderCanvas(size.GetWidth(), size.GetHeight());
}

void MapCanvas::OnPostRender() {
  if (!picture_taken_) return;
  std::array<GLint, 4> viewport{};
  glGetIntegerv(GL_VIEWPORT, viewport.data());
  const wxImage image(viewport[2], viewport[3], false);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, viewport[2], viewport[3], GL_RGB, GL_UNSIGNED_BYTE, image.GetData());
  CallAfter([taken = std::exchange(picture_taken_, {}), picture = image.Mirror(false)] { taken(picture); });
}

void MapCanvas::OnRenderError(const wxString& text) {
  picture_taken_ = {};
  if (std::exchange(reported_failure_, true)) return;
  on.failed("OpenGL cannot draw the map. Check the graphics driver, or map without a window with psi-slam. " +
            text.utf8_string());
}

}  // namespace psi_slam
