// SPDX-License-Identifier: BSD-3-Clause
#include "plot_panel.h"

#include <wx/dcbuffer.h>
#include <wx/graphics.h>
#include <wx/settings.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <string>

#include "base/portable_math.h"
#include "gui/palette.h"
#include "map/report/decade_axis.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

constexpr int kStrips = 4;
constexpr int kPsi = 0;       // index of the plot with a logarithmic axis
constexpr int kResponse = 1;  // index of the plot with unmatched scans
const wxColour kFrontEnd(31, 97, 171);
const wxColour kLoops(0, 145, 90);
const wxColour kGraph(200, 80, 20);
const wxColour kThreshold(200, 30, 40);
const wxColour kUnmatched(colour_of(palette::kUnmatched));

struct Curve {
  wxString name;
  wxColour colour;
  double PlotColumn::*value = nullptr;
};

struct Plot {
  wxString title;
  double least_top = 1;  ///< smallest upper limit of the vertical axis
  std::vector<Curve> curves;
  bool stacked = false;  ///< each curve is drawn on top of the sum of the curves before it

  double value(std::size_t curve, const PlotColumn& column) const {
    double sum = 0;
    for (std::size_t i = stacked ? 0 : curve; i <= curve; ++i) sum += column.*curves[i].value;
    return sum;
  }
};

const std::vector<Plot> kPlots{
    {wxString::FromUTF8("Factor Ψ"), 0.1, {{wxString::FromUTF8("Ψ"), kFrontEnd, &PlotColumn::psi}}},
    {"Response",
     1,
     {{"lowest", kGraph, &PlotColumn::response_min}, {"highest", kFrontEnd, &PlotColumn::response_max}}},
    {"Loops so far",
     1,
     {{"tried", kGraph, &PlotColumn::loops_tried}, {"accepted", kLoops, &PlotColumn::loops_accepted}}},
    {"Scan time [ms]",
     0.1,
     {{"front end", kFrontEnd, &PlotColumn::front_end_ms},
      {"loops", kLoops, &PlotColumn::loops_ms},
      {"pose graph", kGraph, &PlotColumn::graph_ms}},
     true}};

/// Draws one plot into its strip of the panel.
struct PlotPainter {
  wxGraphicsContext& context;
  const wxWindow& window;
  wxRect area;
  const std::vector<PlotColumn>& columns;
  std::size_t frames;
  double top = 1;                       ///< upper end of a linear axis, which starts at 0
  std::optional<DecadeAxis> decades{};  ///< the axis if it is logarithmic

  double x_of(std::size_t frame) const {
    return area.x +
           area.width * static_cast<double>(frame) / std::max<double>(1, static_cast<double>(frames - 1));
  }

  /// Draws axes and curves. The axis is linear and reaches at least up to the plot's least top.
  void draw(const Plot& plot) {
    top = round_up(std::max(plot.least_top, most(plot)));
    draw_with_axes(plot, {{0, number(0)}, {top / 2, number(top / 2)}, {top, number(top)}});
  }

  /// Draws a logarithmic axis, as in the report, the curve of Psi, and the positive thresholds.
  void draw_psi(const Plot& plot, const PsiThresholds& thresholds) {
    decades = psi_axis(most(plot), thresholds);
    draw_with_axes(plot, psi_ticks(*decades));
    for (const double threshold : {thresholds.psi_1, thresholds.psi_2})
      if (threshold > 0) draw_line_at(threshold);
  }

  double most(const Plot& plot) const {
    double most = 0;
    for (std::size_t curve = 0; curve < plot.curves.size(); ++curve)
      for (const PlotColumn& column : columns) most = std::max(most, plot.value(curve, column));
    return most;
  }

  static std::string number(double value) { return wxString::Format("%g", value).utf8_string(); }

  void draw_with_axes(const Plot& plot, const std::vector<AxisTick>& ticks) {
    draw_axes(plot.title, ticks);
    for (std::size_t i = 0; i < plot.curves.size(); ++i)
      draw_curve(plot, plot.stacked ? plot.curves.size() - 1 - i : i);
  }

  void draw_line_at(double value) {
    context.SetPen(wxPen(kThreshold, window.FromDIP(1), wxPENSTYLE_SHORT_DASH));
    context.StrokeLine(area.x, y_of(value), area.x + area.width, y_of(value));
  }

  /// Draws a band over the whole height for each column with unmatched scans.
  void draw_unmatched() {
    context.SetPen(*wxTRANSPARENT_PEN);
    context.SetBrush(wxBrush(kUnmatched));
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (!columns[i].unmatched) continue;
      const double x = x_of(columns[i].first_frame);
      const double end = i + 1 < columns.size() ? x_of(columns[i + 1].first_frame) : area.x + area.width;
      context.DrawRectangle(x, area.y, std::max<double>(window.FromDIP(2), end - x), area.height);
    }
  }

  /// Draws a band at the bottom in the colours of the matchers.
  void draw_matchers() {
    context.SetPen(*wxTRANSPARENT_PEN);
    const double height = window.FromDIP(4);
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (!columns[i].matcher) continue;
      const double x = x_of(columns[i].first_frame);
      const double end = i + 1 < columns.size() ? x_of(columns[i + 1].first_frame) : area.x + area.width;
      context.SetBrush(wxBrush(colour_of(matcher_colour(*columns[i].matcher))));
      context.DrawRectangle(x, area.y + area.height - height, std::max(1.0, end - x), height);
    }
  }

  void draw_legend(const std::vector<Curve>& curves) {
    double x = area.x + area.width;
    context.SetFont(window.GetFont().Smaller(), wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOWTEXT));
    for (auto curve = curves.rbegin(); curve != curves.rend(); ++curve) {
      double width = 0;
      double height = 0;
      context.GetTextExtent(curve->name, &width, &height);
      x -= width;
      const double y = area.y - window.FromDIP(18);
      context.DrawText(curve->name, x, y);
      const double side = window.FromDIP(8);
      x -= side + window.FromDIP(4);
      context.SetPen(*wxTRANSPARENT_PEN);
      context.SetBrush(wxBrush(curve->colour));
      context.DrawRectangle(x, y + (height - side) / 2, side, side);
      x -= window.FromDIP(12);
    }
  }

  double y_of(double value) const {
    return area.y + area.height * (1 - (decades ? decades->share(value) : value / top));
  }

  /// Draws a line at each tick, and its label where the labels do not overlap.
  void draw_axes(const wxString& title, const std::vector<AxisTick>& ticks) {
    const wxColour faint = wxSystemSettings::GetColour(wxSYS_COLOUR_GRAYTEXT);
    context.SetFont(window.GetFont().Bold(), wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOWTEXT));
    context.DrawText(title, area.x, area.y - window.FromDIP(19));
    context.SetFont(window.GetFont().Smaller(), faint);
    context.SetPen(wxPen(wxColour(faint.Red(), faint.Green(), faint.Blue(), 70)));
    double free_above = std::numeric_limits<double>::infinity();
    for (const AxisTick& tick : ticks) {
      const double y = y_of(tick.value);
      context.StrokeLine(area.x, y, area.x + area.width, y);
      const wxString label = text_of(tick.label);
      double width = 0;
      double height = 0;
      context.GetTextExtent(label, &width, &height);
      if (y + height / 2 > free_above) continue;
      context.DrawText(label, area.x - width - window.FromDIP(5), y - height / 2);
      free_above = y - height / 2;
    }
  }

  void draw_curve(const Plot& plot, std::size_t curve) {
    wxGraphicsPath path = context.CreatePath();
    for (const PlotColumn& column : columns) {
      const double x = x_of(column.first_frame);
      const double y = y_of(std::max(0.0, plot.value(curve, column)));
      &column == &columns.front() ? path.MoveToPoint(x, y) : path.AddLineToPoint(x, y);
    }
    context.SetPen(wxPen(plot.curves[curve].colour, std::max(1, window.FromDIP(3) / 2)));
    context.StrokePath(path);
  }
};

void add(PlotColumn& column, const FrameRecord& frame) {
  column.psi = std::max(column.psi, frame.psi);
  if (frame.response > 0) {
    column.response_min =
        column.response_max == 0 ? frame.response : std::min(column.response_min, frame.response);
    column.response_max = std::max(column.response_max, frame.response);
  }
  column.loops_accepted += std::max(0, frame.loops_accepted);
  column.loops_tried += std::max(0, frame.loops_tried);
  column.front_end_ms += frame.front_end_ms;
  column.loops_ms += frame.loop_closing_ms;
  column.graph_ms += frame.pose_graph_ms;
  column.unmatched = column.unmatched || frame.match == ScanMatch::kUnmatched;
  if (frame.matcher) column.matcher = frame.matcher;
}

}  // namespace

std::vector<PlotColumn> plot_columns(const HistoryView<FrameRecord>& frames, std::size_t columns) {
  std::vector<PlotColumn> result;
  const std::size_t count = std::min(columns, frames.size());
  result.reserve(count);
  PlotColumn before;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t first = i * frames.size() / count;
    const std::size_t end = (i + 1) * frames.size() / count;
    PlotColumn column;
    column.first_frame = first;
    column.matcher = before.matcher;
    column.loops_accepted = before.loops_accepted;
    column.loops_tried = before.loops_tried;
    for (std::size_t frame = first; frame < end; ++frame) add(column, frames[frame]);
    const auto scans = static_cast<double>(end - first);
    for (double* mean : {&column.front_end_ms, &column.loops_ms, &column.graph_ms}) *mean /= scans;
    before = column;
    result.push_back(column);
  }
  return result;
}

double round_up(double value) {
  if (!(value > 0)) return 1;
  const double power = portable::pow(10, std::floor(portable::log10(value)));
  for (const double digit : {1.0, 2.0, 5.0})
    if (value <= digit * power * (1 + 1e-9)) return digit * power;
  return 10 * power;
}

PlotPanel::PlotPanel(wxWindow* parent, std::function<void(std::size_t)> go_to)
    : wxPanel(parent, wxID_ANY, wxDefaultPosition, wxDefaultSize, wxFULL_REPAINT_ON_RESIZE),
      go_to_(std::move(go_to)) {
  SetName("plots");
  SetBackgroundStyle(wxBG_STYLE_PAINT);
  Bind(wxEVT_PAINT, [this](wxPaintEvent&) { paint(); });
  Bind(wxEVT_LEFT_DOWN, [this](wxMouseEvent& event) {
    if (!snapshot_ || snapshot_->frames.empty()) return;
    const wxRect area = strip(0);
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

wxRect PlotPanel::strip(int index) const {
  const wxSize size = GetClientSize();
  const int left = FromDIP(52);
  const int title = FromDIP(20);
  const int height = size.GetHeight() / kStrips;
  return {left, index * height + title, std::max(1, size.GetWidth() - left - FromDIP(10)),
          std::max(1, height - title - FromDIP(6))};
}

void PlotPanel::paint() {
  wxAutoBufferedPaintDC dc(this);
  dc.SetBackground(wxBrush(wxSystemSettings::GetColour(wxSYS_COLOUR_WINDOW)));
  dc.Clear();
  if (!snapshot_ || snapshot_->frames.empty()) {
    dc.SetFont(GetFont());
    dc.SetTextForeground(wxSystemSettings::GetColour(wxSYS_COLOUR_GRAYTEXT));
    dc.DrawLabel("Plots of the run appear here while it plays", wxRect(GetClientSize()), wxALIGN_CENTRE);
    return;
  }
  const std::vector<PlotColumn> columns =
      plot_columns(snapshot_->frames, static_cast<std::size_t>(strip(0).width));
  const std::unique_ptr<wxGraphicsContext> context(wxGraphicsContext::Create(dc));
  std::vector<PlotPainter> painters;
  for (int i = 0; i < kStrips; ++i) {
    painters.push_back({*context, *this, strip(i), columns, snapshot_->frames.size()});
    const Plot& plot = kPlots[static_cast<std::size_t>(i)];
    if (i == kResponse) painters.back().draw_unmatched();
    i == kPsi ? painters.back().draw_psi(plot, snapshot_->psi) : painters.back().draw(plot);
    std::vector<Curve> curves = plot.curves;
    if (i == kResponse && snapshot_->unmatched->count > 0) curves.push_back({"not matched", kUnmatched});
    if (i != kPsi) painters.back().draw_legend(curves);
  }
  painters[kPsi].draw_matchers();
  std::vector<Curve> legend{{"thresholds", kThreshold}};
  for (const MatcherKind matcher : kMatcherKinds)
    if (std::any_of(columns.begin(), columns.end(),
                    [&](const PlotColumn& column) { return column.matcher == matcher; }))
      legend.push_back({name(matcher), colour_of(matcher_colour(matcher))});
  painters[kPsi].draw_legend(legend);
  if (!frame_) return;
  const double x = painters[0].x_of(*frame_);
  context->SetPen(wxPen(colour_of(palette::kChosen), FromDIP(1)));
  context->StrokeLine(x, 0, x, GetClientSize().GetHeight());
}

}  // namespace psi_slam
