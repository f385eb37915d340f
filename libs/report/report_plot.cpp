// SPDX-License-Identifier: BSD-3-Clause
#include "report/report_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

#include "report/html_text.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

constexpr double kWidth = 1000;
constexpr double kHeight = 230;
constexpr double kLeft = 66;
constexpr double kRight = 12;
constexpr double kTop = 12;
constexpr double kBottom = 34;

/// One figure of one scan, at its time since the first.
struct Sample {
  double time_s = 0;
  double value = 0;
};

struct Tick {
  double value = 0;
  std::string label;
};

/// From time and value to the plot's own units.
struct Axes {
  double last_s = 1;
  double low = 0;
  double high = 1;
  bool logarithmic = false;

  double x(double time_s) const { return kLeft + time_s / last_s * (kWidth - kLeft - kRight); }
  double y(double value) const {
    const double share = logarithmic ? std::log(std::max(value, low) / low) / std::log(high / low)
                                     : (value - low) / (high - low);
    return kHeight - kBottom - std::clamp(share, 0.0, 1.0) * (kHeight - kTop - kBottom);
  }
};

/// What all samples of one stretch of time have in common.
struct Bin {
  double sum = 0;
  double least = std::numeric_limits<double>::infinity();
  double most = -std::numeric_limits<double>::infinity();
  int count = 0;
};

std::vector<Bin> binned(const std::vector<Sample>& samples, double last_s) {
  const auto bins = static_cast<std::size_t>(std::clamp(static_cast<double>(samples.size()) / 4, 1.0, 320.0));
  std::vector<Bin> result(bins);
  for (const Sample& sample : samples) {
    const double place = sample.time_s / last_s * static_cast<double>(bins);
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

/// A band from the least to the most and a line along the means; both break where there is no sample.
std::string band_and_mean(const std::vector<Bin>& bins, const Axes& axes) {
  std::string band;
  std::string line;
  const double step = axes.last_s / static_cast<double>(bins.size());
  for (std::size_t begin = 0; begin < bins.size();) {
    if (bins[begin].count == 0) {
      ++begin;
      continue;
    }
    std::size_t end = begin;
    std::string upper;
    std::string lower;
    for (; end < bins.size() && bins[end].count > 0; ++end) {
      const double x = axes.x((static_cast<double>(end) + 0.5) * step);
      upper += 'L' + point(x, axes.y(bins[end].most));
      lower = 'L' + point(x, axes.y(bins[end].least)) + lower;
      line += (end == begin ? 'M' : 'L') + point(x, axes.y(bins[end].sum / bins[end].count));
    }
    upper[0] = 'M';
    band += upper + lower + 'Z';
    begin = end;
  }
  return "<path class=\"band\" d=\"" + band + "\"/><path class=\"mean\" d=\"" + line + "\"/>\n";
}

std::vector<Tick> time_ticks(double last_s) {
  double step = 86400;
  for (const double candidate : {0.1, 0.2, 0.5, 1., 2., 5., 10., 20., 30., 60., 120., 300., 600., 1200.,
                                 1800., 3600., 7200., 18000., 36000.})
    if (last_s / candidate <= 10) {
      step = candidate;
      break;
    }
  std::vector<Tick> ticks;
  for (int i = 0; i * step <= last_s * (1 + 1e-9); ++i) {
    const double time_s = i * step;
    ticks.push_back({time_s, step >= 60  ? fixed_text(time_s / 60, 0) + " min"
                             : step >= 1 ? fixed_text(time_s, 0) + " s"
                                         : fixed_text(time_s, 1) + " s"});
  }
  return ticks;
}

std::string frame_of_plot(const Axes& axes, const std::vector<Tick>& value_ticks) {
  std::string svg;
  for (const Tick& tick : value_ticks) {
    const std::string y = fixed_text(axes.y(tick.value), 1);
    svg += "<path class=\"rule\" d=\"M" + fixed_text(kLeft, 0) + ',' + y + "H" +
           fixed_text(kWidth - kRight, 0) + "\"/><text class=\"value\" x=\"" + fixed_text(kLeft - 8, 0) +
           "\" y=\"" + y + "\" dy=\"4\">" + escape_html(tick.label) + "</text>\n";
  }
  for (const Tick& tick : time_ticks(axes.last_s))
    svg += "<text class=\"time\" x=\"" + fixed_text(axes.x(tick.value), 1) + "\" y=\"" +
           fixed_text(kHeight - 10, 0) + "\">" + escape_html(tick.label) + "</text>\n";
  return svg;
}

std::string plot(const std::string& label, const std::string& content) {
  return "<svg class=\"plot\" viewBox=\"0 0 " + fixed_text(kWidth, 0) + ' ' + fixed_text(kHeight, 0) +
         "\" role=\"img\" aria-label=\"" + escape_html(label) + "\">\n" + content + "</svg>\n";
}

/// Of the log, in the frames' own times.
struct Span {
  TimeUs first_us = 0;
  double length_s = 1;

  explicit Span(const std::vector<FrameRecord>& frames) {
    if (frames.empty()) return;
    TimeUs last_us = first_us = frames.front().time_us;
    for (const FrameRecord& frame : frames) {
      first_us = std::min(first_us, frame.time_us);
      last_us = std::max(last_us, frame.time_us);
    }
    if (last_us > first_us) length_s = seconds(last_us - first_us);
  }
  double since_first(TimeUs time_us) const { return seconds(time_us - first_us); }
};

/// Decades that hold all values from least to most.
Axes decades_around(double least, double most, double last_s) {
  Axes axes{last_s, std::pow(10, std::floor(std::log10(least))), std::pow(10, std::ceil(std::log10(most))),
            true};
  if (axes.high <= axes.low) axes.high = 10 * axes.low;
  return axes;
}

/// That a power of ten needs.
int decimals_of(double value) {
  return std::max(0, -static_cast<int>(std::lround(std::log10(value))));
}

/// "4", "0.35".
std::string short_text(double value) {
  std::string text = fixed_text(value, 2);
  text.erase(text.find_last_not_of('0') + 1);
  if (text.back() == '.') text.pop_back();
  return text;
}

/// A dashed line across the plot, named at its beginning or at its end.
std::string limit_line(const Axes& axes, double value, const std::string& text, bool named_early) {
  const std::string y = fixed_text(axes.y(value), 1);
  const double x = named_early ? kLeft + 4 : kWidth - kRight - 4;
  return "<path class=\"limit\" d=\"M" + fixed_text(kLeft, 0) + ',' + y + "H" +
         fixed_text(kWidth - kRight, 0) + "\"/><text class=\"limit" + (named_early ? " early" : "") +
         "\" x=\"" + fixed_text(x, 0) + "\" y=\"" + y + "\" dy=\"-5\">" + escape_html(text) + "</text>\n";
}

struct DurationPlot {
  Axes axes;
  std::string svg;
};

/// Milliseconds on a logarithmic axis that reaches up to `most_ms` at least.
DurationPlot duration_plot(const std::vector<Sample>& samples, const Span& span, double most_ms) {
  double least_ms = std::numeric_limits<double>::infinity();
  for (const Sample& sample : samples) {
    least_ms = std::min(least_ms, sample.value);
    most_ms = std::max(most_ms, sample.value);
  }
  constexpr double kLeast_ms = 1e-3;
  const Axes axes =
      decades_around(std::max(least_ms, kLeast_ms), std::max(most_ms, kLeast_ms), span.length_s);
  std::vector<Tick> ticks;
  for (double value = axes.low; value <= axes.high * 1.001; value *= 10)
    ticks.push_back({value, value >= 999 ? fixed_text(value / 1000, 0) + " s"
                                         : fixed_text(value, decimals_of(value)) + " ms"});
  return {axes, frame_of_plot(axes, ticks) + band_and_mean(binned(samples, span.length_s), axes)};
}

/// Under the plot: for each stretch of time, on what share of its nodes each matcher was in use.
std::string matcher_strip(const std::vector<FrameRecord>& frames, const Span& span, const Axes& axes) {
  constexpr std::size_t kStretches = 320;
  constexpr double kStripTop = kHeight - kBottom + 4;
  constexpr double kStripHeight = 8;
  std::vector<std::array<int, kMatcherKinds.size()>> nodes(kStretches);
  for (const FrameRecord& frame : frames) {
    if (!frame.matcher) continue;
    const double place = span.since_first(frame.time_us) / span.length_s * static_cast<double>(kStretches);
    ++nodes[std::min(static_cast<std::size_t>(place), kStretches - 1)][static_cast<std::size_t>(*frame.matcher)];
  }
  std::array<std::string, kMatcherKinds.size()> paths;
  // A stretch without a node, where the robot stood, goes on as the one before.
  std::array<int, kMatcherKinds.size()> last{};
  for (std::size_t i = 0; i < kStretches; ++i) {
    if (std::accumulate(nodes[i].begin(), nodes[i].end(), 0) > 0) last = nodes[i];
    const int all = std::accumulate(last.begin(), last.end(), 0);
    const double x = axes.x(static_cast<double>(i) / kStretches * axes.last_s);
    const double width = axes.x(static_cast<double>(i + 1) / kStretches * axes.last_s) - x;
    double y = kStripTop;
    for (std::size_t m = 0; m < kMatcherKinds.size(); ++m) {
      if (last[m] == 0) continue;
      const double height = kStripHeight * last[m] / all;
      paths[m] += 'M' + point(x, y) + 'h' + fixed_text(width, 2) + 'v' + fixed_text(height, 2) + 'h' +
                  fixed_text(-width, 2) + 'z';
      y += height;
    }
  }
  std::string svg;
  for (std::size_t m = 0; m < kMatcherKinds.size(); ++m)
    if (!paths[m].empty())
      svg += "<path class=\"matcher " + std::string(name(kMatcherKinds[m])) + "\" d=\"" + paths[m] + "\"/>\n";
  return svg;
}

}  // namespace

std::string response_plot(const MappingResult& result) {
  const Span span(result.frames);
  std::vector<Sample> samples;
  for (const FrameRecord& frame : result.frames)
    if (frame.response > 0) samples.push_back({span.since_first(frame.time_us), frame.response});
  const Axes axes{span.length_s, 0, 1, false};
  std::string svg = frame_of_plot(axes, {{0, "0"}, {0.25, "0.25"}, {0.5, "0.5"}, {0.75, "0.75"}, {1, "1"}});
  svg += band_and_mean(binned(samples, span.length_s), axes);
  std::string closed;
  for (const LoopRecord& loop : result.loops)
    if (loop.verdict == LoopVerdict::kAccepted && !loop.in_final_search)
      closed += 'M' +
                point(axes.x(span.since_first(result.frames.at(loop.frame).time_us)), kHeight - kBottom) +
                "v-10";
  svg += "<path class=\"closed\" d=\"" + closed + "\"/>\n";
  return plot("Response of the front end over time", svg);
}

std::string psi_plot(const MappingResult& result) {
  const Span span(result.frames);
  std::vector<Sample> samples;
  double most = std::max(1.0, result.psi.psi_2);
  for (const FrameRecord& frame : result.frames) {
    samples.push_back({span.since_first(frame.time_us), frame.psi});
    most = std::max(most, frame.psi);
  }
  // Where no loop was closed of late, Psi is 0: it lies on the lowest line. So would a threshold of 0 or
  // less, which Psi is always above.
  double least = 0.1;
  for (const double threshold : {result.psi.psi_1, result.psi.psi_2})
    if (threshold > 0) least = std::min(least, threshold / 10);
  Axes axes = decades_around(std::max(least, 1e-6 * most), most, span.length_s);
  std::vector<Tick> ticks;
  for (double value = axes.low; value <= axes.high * 1.001; value *= 10)
    ticks.push_back({value, fixed_text(value, decimals_of(value))});
  ticks.front().label = "≤ " + ticks.front().label;
  std::string svg = frame_of_plot(axes, ticks);
  svg += band_and_mean(binned(samples, span.length_s), axes);
  if (result.psi.psi_1 > 0)
    svg += limit_line(axes, result.psi.psi_1, "Ψ₁ = " + short_text(result.psi.psi_1), true);
  if (result.psi.psi_2 > 0)
    svg += limit_line(axes, result.psi.psi_2, "Ψ₂ = " + short_text(result.psi.psi_2), true);
  svg += matcher_strip(result.frames, span, axes);
  return plot("The factor Ψ over time", svg);
}

std::string psi_key(const MappingResult& result) {
  std::string key;
  for (const MatcherKind kind : kMatcherKinds)
    if (std::any_of(result.frames.begin(), result.frames.end(),
                    [&](const FrameRecord& frame) { return frame.matcher == kind; }))
      key += "<span class=\"key matcher " + std::string(name(kind)) + "\"></span>" + name(kind);
  return key;
}

std::string loop_matching_plot(const MappingResult& result) {
  const Span span(result.frames);
  std::vector<Sample> samples;
  for (const FrameRecord& frame : result.frames)
    if (frame.loops_tried > 0) samples.push_back({span.since_first(frame.time_us), frame.loop_matching_ms});
  if (samples.empty()) return "<p class=\"none\">No loop was searched for.</p>\n";
  return plot("Time of matching loops for each node over time", duration_plot(samples, span, 0).svg);
}

std::string work_plot(const MappingResult& result) {
  const Span span(result.frames);
  std::vector<Sample> samples;
  for (const FrameRecord& frame : result.frames) {
    const double work_ms = frame.front_end_ms + frame.loop_closing_ms + frame.pose_graph_ms;
    if (work_ms > 0) samples.push_back({span.since_first(frame.time_us), work_ms});
  }
  if (samples.empty()) return "<p class=\"none\">No times were measured.</p>\n";
  const double period_ms =
      result.frames.size() < 2 ? 0 : 1e3 * span.length_s / static_cast<double>(result.frames.size() - 1);
  DurationPlot work = duration_plot(samples, span, period_ms);
  if (period_ms > 0)
    work.svg +=
        limit_line(work.axes, period_ms, "a scan comes every " + milliseconds_text(period_ms) + " ms", false);
  return plot("Work for each scan over time", work.svg);
}

}  // namespace psi_slam
