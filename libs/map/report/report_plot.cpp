// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "map/report/decade_axis.h"
#include "map/report/html_text.h"
#include "map/report/report_sections.h"

namespace psi_slam {
namespace {

constexpr double kWidth = 1000;
constexpr double kHeight = 230;
constexpr double kLeft = 66;
constexpr double kRight = 12;
constexpr double kTop = 12;
constexpr double kBottom = 34;

struct Sample {
  double time_s = 0;  // time since the earliest scan
  double value = 0;
};

/// One value of each scan over the time of the log.
struct Series {
  TimeUs first_us = 0;
  double length_s = 1;
  std::vector<Sample> samples;

  /// Takes the scans for which `value` returns a value.
  Series(const std::vector<FrameRecord>& frames,
         const std::function<std::optional<double>(const FrameRecord&)>& value) {
    if (frames.empty()) return;
    TimeUs last_us = first_us = frames.front().time_us;
    for (const FrameRecord& frame : frames) {
      first_us = std::min(first_us, frame.time_us);
      last_us = std::max(last_us, frame.time_us);
    }
    if (last_us > first_us) length_s = seconds(last_us - first_us);
    for (const FrameRecord& frame : frames)
      if (const auto sample = value(frame)) samples.push_back({since_first(frame.time_us), *sample});
  }
  double since_first(TimeUs time_us) const { return seconds(time_us - first_us); }
  double most(double at_least) const {
    for (const Sample& sample : samples) at_least = std::max(at_least, sample.value);
    return at_least;
  }
};

/// Converts times and values to the coordinates of the plot, y downwards.
struct Axes {
  double last_s = 1;
  double low = 0;
  double high = 1;
  bool logarithmic = false;

  double x(double time_s) const { return kLeft + time_s / last_s * (kWidth - kLeft - kRight); }
  double y(double value) const {
    const double share = logarithmic ? DecadeAxis{low, high}.share(value) : (value - low) / (high - low);
    return kHeight - kBottom - std::clamp(share, 0.0, 1.0) * (kHeight - kTop - kBottom);
  }
};

/// Returns a logarithmic axis over a time from 0 to last_s.
Axes axes_of(const DecadeAxis& decades, double last_s) {
  return {last_s, decades.low, decades.high, true};
}

std::vector<AxisTick> time_ticks(double last_s) {
  constexpr std::array kSteps_s{0.1,  0.2,  0.5,  1.,    2.,    5.,    10.,   20.,    30.,    60.,
                                120., 300., 600., 1200., 1800., 3600., 7200., 18000., 36000., 86400.};
  double step = *std::find_if(kSteps_s.begin(), kSteps_s.end() - 1,
                              [&](double step_s) { return last_s / step_s <= 10; });
  constexpr double kMostTicks = 100;
  while (last_s / step > kMostTicks) step *= 10;  // time stamps may be absurd
  std::vector<AxisTick> ticks;
  for (int i = 0; i * step <= last_s * (1 + 1e-9); ++i) {
    const double time_s = i * step;
    ticks.push_back({time_s, step >= 60  ? fixed_text(time_s / 60, 0) + " min"
                             : step >= 1 ? fixed_text(time_s, 0) + " s"
                                         : fixed_text(time_s, 1) + " s"});
  }
  return ticks;
}

/// Sum, least and greatest value, and number of the samples of one stretch of time.
struct Bin {
  double sum = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  int count = 0;
};

std::vector<Bin> binned(const Series& series) {
  const auto bins =
      static_cast<std::size_t>(std::clamp(static_cast<double>(series.samples.size()) / 4, 1.0, 320.0));
  std::vector<Bin> result(bins);
  for (const Sample& sample : series.samples) {
    const double place = sample.time_s / series.length_s * static_cast<double>(bins);
    Bin& bin = result[std::min(static_cast<std::size_t>(std::max(place, 0.0)), bins - 1)];
    bin.sum += sample.value;
    bin.least = std::min(bin.least, sample.value);
    bin.most = std::max(bin.most, sample.value);
    ++bin.count;
  }
  return result;
}

std::string point(double x, double y) {
  return fixed_text(x, 1) + ',' + fixed_text(y, 1);
}

/// Draws a band from minimum to maximum and a line along the means. Both have gaps where there are no
/// samples.
std::string band_and_mean(const Series& series, const Axes& axes) {
  const std::vector<Bin> bins = binned(series);
  std::string band;
  std::string line;
  std::string upper;  // upper edge of the band since the last gap
  std::string lower;
  const double step = axes.last_s / static_cast<double>(bins.size());
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].count > 0) {
      const double x = axes.x((static_cast<double>(i) + 0.5) * step);
      const char command = upper.empty() ? 'M' : 'L';
      upper += command + point(x, axes.y(bins[i].most));
      lower = 'L' + point(x, axes.y(bins[i].least)) + lower;
      line += command + point(x, axes.y(bins[i].sum / bins[i].count));
    }
    if (upper.empty() || (i + 1 < bins.size() && bins[i + 1].count > 0)) continue;
    band += std::exchange(upper, {}) + std::exchange(lower, {}) + 'Z';
  }
  return "<path class=\"band\" d=\"" + band + "\"/><path class=\"mean\" d=\"" + line + "\"/>\n";
}

/// Draws a horizontal line across the plot, and its label at `label_x`, moved down by `label_dy`.
std::string level(const Axes& axes, double value, const std::string& line_class, const std::string& label,
                  const std::string& label_class, double label_x, int label_dy) {
  const std::string y = fixed_text(axes.y(value), 1);
  return "<path class=\"" + line_class + "\" d=\"M" + fixed_text(kLeft, 0) + ',' + y + "H" +
         fixed_text(kWidth - kRight, 0) + "\"/><text class=\"" + label_class + "\" x=\"" +
         fixed_text(label_x, 0) + "\" y=\"" + y + "\" dy=\"" + std::to_string(label_dy) + "\">" +
         escape_html(label) + "</text>\n";
}

/// Draws the grid, the labels of both axes, and the series.
std::string plot_of(const Series& series, const Axes& axes, const std::vector<AxisTick>& value_ticks) {
  std::string svg;
  for (const AxisTick& tick : value_ticks)
    svg += level(axes, tick.value, "rule", tick.label, "value", kLeft - 8, 4);
  for (const AxisTick& tick : time_ticks(axes.last_s))
    svg += "<text class=\"time\" x=\"" + fixed_text(axes.x(tick.value), 1) + "\" y=\"" +
           fixed_text(kHeight - 10, 0) + "\">" + escape_html(tick.label) + "</text>\n";
  return svg + band_and_mean(series, axes);
}

std::string figure(const std::string& label, const std::string& content) {
  return "<svg class=\"plot\" viewBox=\"0 0 " + fixed_text(kWidth, 0) + ' ' + fixed_text(kHeight, 0) +
         "\" role=\"img\" aria-label=\"" + escape_html(label) + "\">\n" + content + "</svg>\n";
}

/// Draws a series in milliseconds on a logarithmic axis, with a line at `limit_ms` if it is positive.
std::string duration_plot(const std::string& label, const Series& series, double limit_ms,
                          const std::string& limit_text) {
  constexpr double kLeast_ms = 1e-3;
  double least_ms = std::numeric_limits<double>::infinity();
  for (const Sample& sample : series.samples) least_ms = std::min(least_ms, sample.value);
  const DecadeAxis decades =
      decades_around(std::max(least_ms, kLeast_ms), series.most(std::max(limit_ms, kLeast_ms)));
  const Axes axes = axes_of(decades, series.length_s);
  const auto ticks = decade_ticks(decades, [](double value) {
    return value >= 999 ? fixed_text(value / 1000, 0) + " s" : power_text(value) + " ms";
  });
  return figure(
      label,
      plot_of(series, axes, ticks) +
          (limit_ms > 0 ? level(axes, limit_ms, "limit", limit_text, "limit", kWidth - kRight - 4, -5) : ""));
}

/// Draws the strip below the plot: for each stretch of time, the shares of the searches that ran. Stretches
/// without searches stay empty.
std::string search_strip(const std::vector<FrameRecord>& frames, const Series& series, const Axes& axes) {
  constexpr std::size_t kStretches = 320;
  constexpr double kStripTop = kHeight - kBottom + 4;
  constexpr double kStripHeight = 8;
  std::vector<std::array<int, kSearchKinds.size()>> searches(kStretches);
  for (const FrameRecord& frame : frames) {
    const double place =
        series.since_first(frame.time_us) / series.length_s * static_cast<double>(kStretches);
    auto& stretch = searches[std::min(static_cast<std::size_t>(place), kStretches - 1)];
    for (std::size_t i = 0; i < stretch.size(); ++i) stretch[i] += frame.searches[i];
  }
  std::array<std::string, kSearchKinds.size()> paths;
  for (std::size_t i = 0; i < kStretches; ++i) {
    const int all = std::accumulate(searches[i].begin(), searches[i].end(), 0);
    const double x = axes.x(static_cast<double>(i) / kStretches * axes.last_s);
    const double width = axes.x(static_cast<double>(i + 1) / kStretches * axes.last_s) - x;
    double y = kStripTop;
    for (std::size_t k = 0; k < paths.size(); ++k) {
      if (searches[i][k] == 0) continue;
      const double height = kStripHeight * searches[i][k] / all;
      paths[k] += 'M' + point(x, y) + 'h' + fixed_text(width, 2) + 'v' + fixed_text(height, 2) + 'h' +
                  fixed_text(-width, 2) + 'z';
      y += height;
    }
  }
  std::string svg;
  for (std::size_t k = 0; k < paths.size(); ++k)
    if (!paths[k].empty())
      svg += "<path class=\"search " + std::string(name(kSearchKinds[k])) + "\" d=\"" + paths[k] + "\"/>\n";
  return svg;
}

/// Draws a band over the whole height for each stretch of unmatched scans.
std::string unmatched_bands(const UnmatchedScans& unmatched, const Series& series, const Axes& axes) {
  constexpr double kLeastWidth = 2;
  std::string bands;
  for (const UnmatchedStretch& stretch : unmatched.stretches) {
    const double x = axes.x(series.since_first(stretch.first_time_us));
    const double end = axes.x(series.since_first(stretch.last_time_us));
    bands += 'M' + point(std::min(x, end) - kLeastWidth / 2, kTop) + 'h' +
             fixed_text(std::abs(end - x) + kLeastWidth, 1) + 'V' + fixed_text(kHeight - kBottom, 0) + 'H' +
             fixed_text(std::min(x, end) - kLeastWidth / 2, 1) + 'z';
  }
  return bands.empty() ? "" : "<path class=\"unmatched\" d=\"" + bands + "\"/>\n";
}

std::optional<double> if_positive(double value) {
  return value > 0 ? std::optional(value) : std::nullopt;
}

}  // namespace

std::string response_plot(const MappingResult& result, const UnmatchedScans& unmatched) {
  const Series series(result.frames, [](const FrameRecord& frame) { return if_positive(frame.response); });
  const Axes axes{series.length_s, 0, 1, false};
  std::string closed;
  for (const LoopRecord& loop : result.loops)
    if (loop.state == LoopState::kAccepted && !loop.in_final_search)
      closed += 'M' +
                point(axes.x(series.since_first(result.frames.at(loop.frame).time_us)), kHeight - kBottom) +
                "v-10";
  return figure(
      "Response of the front end over time",
      unmatched_bands(unmatched, series, axes) +
          plot_of(series, axes, {{0, "0"}, {0.25, "0.25"}, {0.5, "0.5"}, {0.75, "0.75"}, {1, "1"}}) +
          "<path class=\"closed\" d=\"" + closed + "\"/>\n");
}

std::string psi_plot(const MappingResult& result) {
  const Series series(result.frames, [](const FrameRecord& frame) { return std::optional(frame.psi); });
  const DecadeAxis decades = psi_axis(series.most(0), result.psi);
  const Axes axes = axes_of(decades, series.length_s);
  std::string svg = plot_of(series, axes, psi_ticks(decades));
  std::vector<std::pair<std::string, double>> thresholds = {{"Ψ₁ = ", result.psi.psi_1},
                                                            {"Ψ₂ = ", result.psi.psi_2}};
  if (result.psi.psi_1 == result.psi.psi_2) thresholds = {{"Ψ₁ = Ψ₂ = ", result.psi.psi_1}};
  for (const auto& [name, threshold] : thresholds)
    if (threshold > 0)  // other thresholds have no place on the axis
      svg += level(axes, threshold, "limit", name + trimmed_text(threshold, 2), "limit early", kLeft + 4, -5);
  return figure("The factor Ψ over time", svg + search_strip(result.frames, series, axes));
}

std::string psi_key(const MappingResult& result) {
  std::string key;
  for (std::size_t i = 0; i < kSearchKinds.size(); ++i)
    if (std::any_of(result.frames.begin(), result.frames.end(),
                    [&](const FrameRecord& frame) { return frame.searches[i] > 0; }))
      key += "<span class=\"key search " + std::string(name(kSearchKinds[i])) + "\"></span>" +
             name(kSearchKinds[i]);
  return key;
}

std::string loop_matching_plot(const MappingResult& result) {
  const Series series(result.frames, [](const FrameRecord& frame) {
    return frame.loops_tried > 0 ? std::optional(frame.loop_matching_ms) : std::nullopt;
  });
  if (series.samples.empty()) return "<p class=\"none\">No loops were searched.</p>\n";
  return duration_plot("Loop matching time per node", series, 0, {});
}

std::string work_plot(const MappingResult& result) {
  const Series series(result.frames, [](const FrameRecord& frame) {
    return if_positive(frame.front_end_ms + frame.loop_closing_ms + frame.pose_graph_ms);
  });
  if (series.samples.empty()) return "<p class=\"none\">No times were measured.</p>\n";
  const double period_ms =
      result.frames.size() < 2 ? 0 : 1e3 * series.length_s / static_cast<double>(result.frames.size() - 1);
  return duration_plot("Processing time per scan", series, period_ms,
                       "time between scans: " + milliseconds_text(period_ms) + " ms");
}

}  // namespace psi_slam
