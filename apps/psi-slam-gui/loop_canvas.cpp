// SPDX-License-Identifier: BSD-3-Clause
#include "loop_canvas.h"

#include <wx/dcbuffer.h>
#include <wx/graphics.h>
#include <wx/settings.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "gui/palette.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr double kAround_m = 1.5;  // margin around the scan
// On each of the four sides, one of this many points may lie outside the picture.
constexpr std::size_t kPointsPerOutlier = 12;

/// Converts positions in the frame of the local map to pixels. The position (x_m, y_m) is at (x_px, y_px).
struct Frame2D {
  double x_m = 0;
  double y_m = 0;
  double x_px = 0;
  double y_px = 0;
  double px_per_m = 1;

  double x(double at_m) const { return x_px + (at_m - x_m) * px_per_m; }
  double y(double at_m) const { return y_px + (y_m - at_m) * px_per_m; }
};

/// Range of the values without one in kPointsPerOutlier at each end.
std::pair<double, double> range_without_outliers(std::vector<double> values) {
  if (values.empty()) return {0, 0};
  std::sort(values.begin(), values.end());
  const std::size_t out = values.size() / kPointsPerOutlier;
  return {values[out], values[values.size() - 1 - out]};
}

/// Returns the frame that centres both scans, with a margin, in the area.
Frame2D frame_for(const LoopPicture& picture, const wxRect& area) {
  std::vector<double> x_m;
  std::vector<double> y_m;
  for (const auto* scan : {&picture.before, &picture.after})
    for (const mrpt::math::TPoint2D& point : *scan) {
      x_m.push_back(point.x);
      y_m.push_back(point.y);
    }
  const auto [x_min, x_max] = range_without_outliers(std::move(x_m));
  const auto [y_min, y_max] = range_without_outliers(std::move(y_m));
  return {
      (x_min + x_max) / 2, (y_min + y_max) / 2, area.x + area.width / 2.0, area.y + area.height / 2.0,
      std::min(area.width / (x_max - x_min + 2 * kAround_m), area.height / (y_max - y_min + 2 * kAround_m))};
}

wxBitmap bitmap_of(const MapRaster& raster) {
  wxImage image(raster.width_px, raster.height_px, false);
  unsigned char* to = image.GetData();
  for (std::size_t i = 0; i + 3 < raster.pixels.size(); i += 4)
    for (const std::size_t channel : {2U, 1U, 0U}) *to++ = raster.pixels[i + channel];
  return wxBitmap(image);
}

}  // namespace

LoopCanvas::LoopCanvas(wxWindow* parent)
    : wxPanel(parent, wxID_ANY, wxDefaultPosition, wxDefaultSize, wxFULL_REPAINT_ON_RESIZE) {
  SetName("loop picture");
  SetBackgroundStyle(wxBG_STYLE_PAINT);
  SetMinSize(FromDIP(wxSize(240, 130)));
  Bind(wxEVT_PAINT, [this](wxPaintEvent&) { paint(); });
}

void LoopCanvas::show(std::optional<LoopPicture> picture) {
  picture_ = std::move(picture);
  local_map_ = picture_ ? bitmap_of(picture_->local_map) : wxBitmap();
  Refresh();
}

void LoopCanvas::paint() {
  wxAutoBufferedPaintDC dc(this);
  dc.SetBackground(wxBrush(wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOW)));
  dc.Clear();
  const wxSize size = GetClientSize();
  if (!picture_) {
    dc.SetFont(GetFont());
    dc.SetTextForeground(wxSystemSettings::GetColour(wxSYS_COLOUR_GRAYTEXT));
    dc.DrawLabel("Select a loop in the table\nto see its scan on its local map", wxRect(size),
                 wxALIGN_CENTRE);
    return;
  }
  const std::unique_ptr<wxGraphicsContext> context(wxGraphicsContext::Create(dc));
  const int half = size.GetWidth() / 2;
  const auto draw_half = [&](const wxRect& area, const auto& scan, const wxColour& colour,
                             const wxString& title) {
    context->Clip(area.x, area.y, area.width, area.height);
    const Frame2D frame = frame_for(*picture_, area);
    const MapRectangle map = picture_->local_map.rectangle();
    context->DrawBitmap(local_map_, frame.x(map.x_min_m), frame.y(map.y_max_m),
                        map.width_m() * frame.px_per_m, map.height_m() * frame.px_per_m);
    context->SetPen(*wxTRANSPARENT_PEN);
    context->SetBrush(wxBrush(colour));
    const double radius = FromDIP(15) / 10.0;
    for (const mrpt::math::TPoint2D& point : scan)
      context->DrawEllipse(frame.x(point.x) - radius, frame.y(point.y) - radius, 2 * radius, 2 * radius);
    context->SetFont(GetFont().Bold(), colour);
    context->DrawText(title, area.x + FromDIP(6), area.y + FromDIP(4));
    context->ResetClip();
  };
  draw_half(wxRect(0, 0, half, size.GetHeight()), picture_->before, colour_of(palette::kBefore), "Predicted");
  draw_half(wxRect(half, 0, size.GetWidth() - half, size.GetHeight()), picture_->after,
            colour_of(palette::kAfter), picture_->after.empty() ? "Not found" : "Matched");
  context->SetPen(wxPen(wxSystemSettings::GetColour(wxSYS_COLOUR_BTNSHADOW)));
  context->StrokeLine(half, 0, half, size.GetHeight());
}

}  // namespace psi_slam
