// SPDX-License-Identifier: BSD-3-Clause
#include "plot_panel.h"

#include <wx/dcbuffer.h>
#include <wx/graphics.h>
#include <wx/settings.h>

#include <algorithm>
#include <cmath>

#include "view/palette.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr int kStrips = 4;
const wxColour kFrontEnd(31, 97, 171);
const wxColour kLoops(0, 145, 90);
const wxColour kGraph(200, 80, 20);
const wxColour kThreshold(200, 30, 40);

}  // namespace

PlotPanel::PlotPanel(wxWindow* parent, std::function<void(std::size_t)> go_to)
    : wxPanel(parent), go_to_(std::move(go_to)) {
  SetName("plots");
  SetBackgroundStyle(wxBG_STYLE_PAINT);
  Bind(wxEVT_PAINT, [this](wxPaintEvent&) { paint(); });
  Bind(wxEVT_SIZE, [this](wxSizeEvent& event) {
    Refresh();
    event.Skip();
  });
  Bind(wxEVT_LEFT_DOWN, [this](wxMouseEvent& event) {
    if (!snapshot_ || snapshot_->frames.empty()) return;
    const wxRect area = strip(0, GetClientSize());
    const double share = static_cast<double>(event.GetX() - area.x) / std::max(1, area.width);
    const auto last = static_cast<double>(snapshot_->frames.size() - 1);
    go_to_(static_cast<std::size_t>(std::clamp(share, 0.0, 1.0) * last));
  });
}

void PlotPanel::show(const std::shared_ptr<const ReplaySnapshot>& snapshot,
                     std::optional<std::size_t> frame) {
  const bool same = snapshot_ && snapshot_->frames.size() == snapshot->frames.size() && frame == frame_;
  snapshot_ = snapshot;
  frame_ = frame;
  if (!same) Refresh();
}

void PlotPanel::show_nothing() {
  snapshot_.reset();
  Refresh();
}

wxRect PlotPanel::strip(int index, const wxSize& size) const {
  const int left = FromDIP(52);
  const int right = FromDIP(10);
  const int title = FromDIP(20);
  const int bottom = FromDIP(6);
  const int height = size.GetHeight() / kStrips;
  return {left, index * height + title, std::max(1, size.GetWidth() - left - right),
          std::max(1, height - title - bottom)};
}

void PlotPanel::paint() {
  wxAutoBufferedPaintDC dc(this);
  dc.SetBackground(wxBrush(wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOW)));
  dc.Clear();
  const wxSize size = GetClientSize();
  if (!snapshot_ || snapshot_->frames.empty()) {
    dc.SetFont(GetFont());
    dc.SetTextForeground(wxSystemSettings::GetColour(wxSYS_COLOUR_GRAYTEXT));
    dc.DrawLabel("The curves of the run appear here as it plays", wxRect(size), wxALIGN_CENTRE);
    return;
  }
  columns_ = plot_columns(snapshot_->frames, static_cast<std::size_t>(strip(0, size).width));
  const std::unique_ptr<wxGraphicsContext> context(wxGraphicsContext::Create(dc));
  draw_psi(*context, strip(0, size));
  draw_response(*context, strip(1, size));
  draw_loops(*context, strip(2, size));
  draw_times(*context, strip(3, size));
  if (!frame_) return;
  const wxRect area = strip(0, size);
  context->SetPen(wxPen(colour_of(palette::kChosen), FromDIP(1)));
  const double x = x_of(area, static_cast<double>(*frame_));
  context->StrokeLine(x, 0, x, size.GetHeight());
}

double PlotPanel::x_of(const wxRect& area, double frame) const {
  return area.x + area.width * frame / std::max<double>(1, static_cast<double>(snapshot_->frames.size() - 1));
}

void PlotPanel::draw_axes(wxGraphicsContext& context, const wxRect& area, const wxString& title,
                          double top) const {
  const wxColour ink = wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOWTEXT);
  const wxColour faint = wxSystemSettings::GetColour(wxSYS_COLOUR_GRAYTEXT);
  context.SetFont(GetFont().Bold(), ink);
  context.DrawText(title, area.x, area.y - FromDIP(19));
  context.SetFont(GetFont().Smaller(), faint);
  context.SetPen(wxPen(wxColour(faint.Red(), faint.Green(), faint.Blue(), 70)));
  for (const double share : {0.0, 0.5, 1.0}) {
    const double y = area.y + area.height * (1 - share);
    context.StrokeLine(area.x, y, area.x + area.width, y);
    const wxString label = wxString::Format("%g", top * share);
    double width = 0;
    double height = 0;
    context.GetTextExtent(label, &width, &height);
    context.DrawText(label, area.x - width - FromDIP(5), y - height / 2);
  }
}

void PlotPanel::draw_curve(wxGraphicsContext& context, const wxRect& area, double top,
                           const Curve& curve) const {
  wxGraphicsPath path = context.CreatePath();
  bool begun = false;
  for (const PlotColumn& column : columns_) {
    const double x = x_of(area, static_cast<double>(column.first_frame));
    const double y = area.y + area.height * (1 - std::clamp(curve.value(column) / top, 0.0, 1.0));
    begun ? path.AddLineToPoint(x, y) : path.MoveToPoint(x, y);
    begun = true;
  }
  context.SetPen(wxPen(curve.colour, std::max(1, FromDIP(3) / 2)));
  context.StrokePath(path);
}

void PlotPanel::draw_legend(wxGraphicsContext& context, const wxRect& area,
                            const std::vector<Curve>& curves) const {
  double x = area.x + area.width;
  context.SetFont(GetFont().Smaller(), wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOWTEXT));
  for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve) {
    double width = 0;
    double height = 0;
    context.GetTextExtent(curve->name, &width, &height);
    x -= width;
    const double y = area.y - FromDIP(18);
    context.DrawText(curve->name, x, y);
    const double side = FromDIP(8);
    x -= side + FromDIP(4);
    context.SetPen(*wxTRANSPARENT_PEN);
    context.SetBrush(wxBrush(curve->colour));
    context.DrawRectangle(x, y + (height - side) / 2, side, side);
    x -= FromDIP(12);
  }
}

/// A band below Psi in the colours of the matchers.
void PlotPanel::draw_matchers(wxGraphicsContext& context, const wxRect& area) const {
  context.SetPen(*wxTRANSPARENT_PEN);
  const double height = FromDIP(4);
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    if (!columns_[i].matcher) continue;
    const double x = x_of(area, static_cast<double>(columns_[i].first_frame));
    const double end = i + 1 < columns_.size() ? x_of(area, static_cast<double>(columns_[i + 1].first_frame))
                                               : area.x + area.width;
    context.SetBrush(wxBrush(colour_of(matcher_colour(*columns_[i].matcher))));
    context.DrawRectangle(x, area.y + area.height - height, std::max(1.0, end - x), height);
  }
}

void PlotPanel::draw_psi(wxGraphicsContext& context, const wxRect& area) const {
  double largest = std::max(0.1, snapshot_->psi.psi_2);
  for (const PlotColumn& column : columns_) largest = std::max(largest, column.psi);
  const double top = round_up(largest);
  draw_axes(context, area, wxString::FromUTF8("Factor \xCE\xA8"), top);
  context.SetPen(wxPen(kThreshold, FromDIP(1), wxPENSTYLE_SHORT_DASH));
  for (const double threshold : {snapshot_->psi.psi_1, snapshot_->psi.psi_2}) {
    if (threshold < 0 || threshold > top) continue;
    const double y = area.y + area.height * (1 - threshold / top);
    context.StrokeLine(area.x, y, area.x + area.width, y);
  }
  draw_matchers(context, area);
  const Curve psi{wxString::FromUTF8("\xCE\xA8"), kFrontEnd,
                  [](const PlotColumn& column) { return column.psi; }};
  draw_curve(context, area, top, psi);
  std::vector<Curve> legend{{"thresholds", kThreshold, {}}};
  for (const MatcherKind matcher : kMatcherKinds)
    if (std::any_of(columns_.begin(), columns_.end(),
                    [&](const PlotColumn& column) { return column.matcher == matcher; }))
      legend.push_back({name(matcher), colour_of(matcher_colour(matcher)), {}});
  draw_legend(context, area, legend);
}

void PlotPanel::draw_response(wxGraphicsContext& context, const wxRect& area) const {
  draw_axes(context, area, "Response", 1);
  const std::vector<Curve> curves{
      {"least", kGraph, [](const PlotColumn& column) { return column.response_min; }},
      {"best", kFrontEnd, [](const PlotColumn& column) { return column.response_max; }}};
  for (const Curve& curve : curves) draw_curve(context, area, 1, curve);
  draw_legend(context, area, curves);
}

void PlotPanel::draw_loops(wxGraphicsContext& context, const wxRect& area) const {
  const std::vector<Curve> curves{
      {"tried", kGraph, [](const PlotColumn& column) { return static_cast<double>(column.loops_tried); }},
      {"closed", kLoops,
       [](const PlotColumn& column) { return static_cast<double>(column.loops_accepted); }}};
  const double top = round_up(std::max(1.0, curves[0].value(columns_.back())));
  draw_axes(context, area, "Loops so far", top);
  for (const Curve& curve : curves) draw_curve(context, area, top, curve);
  draw_legend(context, area, curves);
}

void PlotPanel::draw_times(wxGraphicsContext& context, const wxRect& area) const {
  const auto sum = [](const PlotColumn& column) {
    return column.front_end_ms + column.loops_ms + column.graph_ms;
  };
  double largest = 0;
  for (const PlotColumn& column : columns_) largest = std::max(largest, sum(column));
  const double top = round_up(std::max(largest, 0.1));
  draw_axes(context, area, "ms a scan", top);
  const std::vector<Curve> curves{
      {"front end", kFrontEnd, [](const PlotColumn& column) { return column.front_end_ms; }},
      {"loops", kLoops, [](const PlotColumn& column) { return column.front_end_ms + column.loops_ms; }},
      {"pose graph", kGraph, sum}};
  for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve) draw_curve(context, area, top, *curve);
  draw_legend(context, area, curves);
}

}  // namespace psi_slam
