// SPDX-License-Identifier: BSD-3-Clause
#include "report/report_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "report/html_text.h"
#include "rendering/map_image.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr int kImageSide_px = 2000;
constexpr std::size_t kDrawnLoopsOfAKind = 500;  ///< more would hide the map

struct Pixel {
  double x = 0;
  double y = 0;
};

using Path = std::vector<Pixel>;

/// From the map, in metres, to the picture, in pixels with y downwards.
class Projection {
 public:
  explicit Projection(const MapPicture& picture) : picture_(picture) {}
  Pixel operator()(const TPose2D& pose) const {
    return {(pose.x - picture_.x_min_m) / picture_.resolution_m,
            (picture_.y_max_m - pose.y) / picture_.resolution_m};
  }

 private:
  const MapPicture& picture_;
};

std::string text(const Pixel& pixel) {
  return fixed_text(pixel.x, 1) + ',' + fixed_text(pixel.y, 1);
}

/// Without the points that nobody could tell from the one before.
Path thinned(const Path& path) {
  constexpr double kStep_px = 1.5;
  Path kept;
  for (const Pixel& point : path)
    if (kept.empty() || std::hypot(point.x - kept.back().x, point.y - kept.back().y) >= kStep_px)
      kept.push_back(point);
  if (!path.empty() && path.size() > 1) kept.push_back(path.back());
  return kept;
}

using Paths = std::vector<Path>;  // one of each drive

std::string path_data(Path::const_iterator begin, Path::const_iterator end) {
  std::string data;
  for (auto point = begin; point != end; ++point) data += (point == begin ? 'M' : 'L') + text(*point);
  return data;
}

/// Blue at the start, over violet and pink, to orange at the end: legible on light and dark ground.
std::string time_colour(double share) {
  struct Rgb {
    double red, green, blue;
  };
  constexpr std::array<Rgb, 4> kStops = {{{47, 98, 235}, {139, 77, 230}, {226, 62, 140}, {247, 126, 24}}};
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double u = place - static_cast<double>(before);
  const auto mixed = [&](double Rgb::*part) {
    return std::to_string(std::lround(kStops[before].*part * (1 - u) + kStops[before + 1].*part * u));
  };
  return "rgb(" + mixed(&Rgb::red) + ',' + mixed(&Rgb::green) + ',' + mixed(&Rgb::blue) + ')';
}

/// A dot of the same size at every zoom: a line of no length with a round end.
std::string dot(const char* css_class, const Pixel& at) {
  const std::string data = "d=\"M" + text(at) + "h0\"";
  return "<path class=\"rim\" " + data + "/><path class=\"" + css_class + "\" " + data + "><title>" +
         css_class + "</title></path>\n";
}

std::string coloured(const Path& path) {
  constexpr std::size_t kColours = 48;
  std::string svg;
  const std::size_t last = path.empty() ? 0 : path.size() - 1;
  for (std::size_t i = 0; i < kColours; ++i) {
    const auto begin = static_cast<std::ptrdiff_t>(last * i / kColours);
    const auto end = static_cast<std::ptrdiff_t>(last * (i + 1) / kColours);
    if (begin == end) continue;
    svg += "<path stroke=\"" + time_colour((static_cast<double>(i) + 0.5) / kColours) + "\" d=\"" +
           path_data(path.begin() + begin, path.begin() + end + 1) + "\"/>\n";
  }
  return svg;
}

std::string trajectory_layer(const Paths& paths) {
  std::string svg = "<g class=\"layer trajectory\">\n";
  for (const Path& path : paths) svg += coloured(path);
  return svg + "</g>\n";
}

std::string ends_layer(const Paths& paths) {
  std::string svg = "<g class=\"layer trajectory\">\n";
  for (const Path& path : paths)
    if (!path.empty()) svg += dot("start", path.front()) + dot("end", path.back());
  return svg + "</g>\n";
}

std::string path_layer(const char* name, const Paths& paths) {
  std::string data;
  for (const Path& path : paths) data += path_data(path.begin(), path.end());
  return "<g class=\"layer " + std::string(name) + "\"><path d=\"" + data + "\"/></g>\n";
}

std::string loop_title(const LoopRecord& loop) {
  std::string title = "node " + std::to_string(loop.node) + " to local map " +
                      std::to_string(loop.local_map) + ", response " + fixed_text(loop.response, 2) + ", " +
                      name(loop.matcher);
  if (loop.refusal) title += ": " + text_of(loop.refusal);
  return title;
}

std::size_t count_of(const MappingResult& result, LoopVerdict verdict) {
  return static_cast<std::size_t>(
      std::count_if(result.loops.begin(), result.loops.end(),
                    [&](const LoopRecord& loop) { return loop.verdict == verdict; }));
}

/// The loops of one verdict, or evenly chosen ones where there are too many.
std::string loop_layer(const char* name, const MappingResult& result, LoopVerdict verdict,
                       const Projection& project) {
  const auto place = [&](std::size_t node) {
    return project(result.frames.at(result.node_frames.at(node)).map_T_robot);
  };
  const std::size_t count = count_of(result, verdict);
  const std::size_t drawn = std::min(count, kDrawnLoopsOfAKind);
  std::string svg = "<g class=\"layer loop " + std::string(name) + "\">\n";
  std::size_t seen = 0;
  for (const LoopRecord& loop : result.loops) {
    if (loop.verdict != verdict) continue;
    const bool chosen = seen * drawn / count != (seen + 1) * drawn / count;
    ++seen;
    if (!chosen) continue;
    svg += "<path d=\"M" + text(place(loop.anchor)) + 'L' + text(place(loop.node)) + "\"><title>" +
           escape_html(loop_title(loop)) + "</title></path>\n";
  }
  return svg + "</g>\n";
}

/// Poses told in a frame of their own, laid onto the map where each drive begins, so that their drift is
/// seen.
using PoseOfFrame = std::function<TPose2D(const FrameRecord& frame, const FrameRecord& first_of_drive)>;

Paths paths_of(const MappingResult& result, const PoseOfFrame& map_T_robot, const Projection& project) {
  Paths paths;
  for (const FrameSpan& drive : runs_of(result)) {
    Path path;
    for (std::size_t i = drive.begin; i < drive.end; ++i)
      path.push_back(project(map_T_robot(result.frames[i], result.frames[drive.begin])));
    paths.push_back(thinned(path));
  }
  return paths;
}

/// Poses of another frame, each drive moved to where it starts in the map.
PoseOfFrame from_start(TPose2D FrameRecord::*pose) {
  return [pose](const FrameRecord& frame, const FrameRecord& first) {
    return first.map_T_robot + (frame.*pose - first.*pose);
  };
}

TPose2D mapped(const FrameRecord& frame, const FrameRecord& /*first_of_drive*/) {
  return frame.map_T_robot;
}

std::string scale_bar(const MapPicture& picture) {
  double bar_m = 1;
  for (const double length_m : {1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 500.0, 1000.0})
    if (length_m / picture.resolution_m < picture.width_px / 6.0) bar_m = length_m;
  const double bar_px = bar_m / picture.resolution_m;
  const double unit = std::max(picture.width_px, picture.height_px) / 100.0;
  const Pixel left{unit, picture.height_px - 1.5 * unit};
  return "<g class=\"scale\"><path d=\"M" + text({left.x, left.y - unit / 2}) + "v" + fixed_text(unit, 1) +
         "M" + text(left) + "h" + fixed_text(bar_px, 1) + "m0," + fixed_text(-unit / 2, 1) + "v" +
         fixed_text(unit, 1) + "\"/><text x=\"" + fixed_text(left.x + bar_px + unit, 1) + "\" y=\"" +
         fixed_text(left.y + unit / 2, 1) + "\" font-size=\"" + fixed_text(1.5 * unit, 1) + "\">" +
         fixed_text(bar_m, 0) + " m</text></g>\n";
}

std::string view_box(double x_min, double y_min, double x_max, double y_max) {
  return fixed_text(x_min, 0) + ' ' + fixed_text(y_min, 0) + ' ' + fixed_text(x_max - x_min, 0) + ' ' +
         fixed_text(y_max - y_min, 0);
}

/// What must be in sight to see a path that strays from the map.
std::string view_box_with(const Paths& paths, const MapPicture& picture) {
  double x_min = 0;
  double y_min = 0;
  double x_max = picture.width_px;
  double y_max = picture.height_px;
  for (const Path& path : paths)
    for (const Pixel& point : path) {
      x_min = std::min(x_min, point.x - 20);
      y_min = std::min(y_min, point.y - 20);
      x_max = std::max(x_max, point.x + 20);
      y_max = std::max(y_max, point.y + 20);
    }
  return view_box(x_min, y_min, x_max, y_max);
}

std::string toggle(const char* layer, const std::string& label, bool shown, const std::string& view = {}) {
  const std::string id = std::string("show-") + layer;
  return "<input type=\"checkbox\" id=\"" + id + "\"" + (shown ? " checked" : "") +
         (view.empty() ? "" : " data-view=\"" + view + "\"") + "><label for=\"" + id + "\">" +
         escape_html(label) + "</label>\n";
}

std::string loops_label(const char* what, const MappingResult& result, LoopVerdict verdict) {
  return std::string(what) + " (" + grouped(static_cast<std::int64_t>(count_of(result, verdict))) + ')';
}

std::string sampling_note(const MappingResult& result) {
  for (const LoopVerdict verdict : {LoopVerdict::kAccepted, LoopVerdict::kRefused, LoopVerdict::kSwitchedOff})
    if (count_of(result, verdict) > kDrawnLoopsOfAKind)
      return "Of loops of a kind at most " + std::to_string(kDrawnLoopsOfAKind) +
             " are drawn, evenly chosen. ";
  return {};
}

}  // namespace

std::string report_map(const MappingResult& result, const mrpt::maps::COccupancyGridMap2D& grid) {
  MapPictureOptions options;
  options.max_side_px = kImageSide_px;
  options.min_side_px = 1;
  options.transparent_unknown = true;
  options.scale_bar = false;
  const MapPicture picture = map_picture(grid, options);
  const Projection project(picture);
  const Paths odometry = paths_of(result, from_start(&FrameRecord::odom_T_robot), project);
  const Paths front_end = paths_of(result, from_start(&FrameRecord::front_end_T_robot), project);
  const std::string size = "width=\"" + std::to_string(picture.width_px) + "\" height=\"" +
                           std::to_string(picture.height_px) + "\"";

  std::string html = "<div class=\"map\">\n";
  html += toggle("grid", "map", true);
  html += toggle("trajectory", "trajectory", true);
  html += toggle("accepted", loops_label("loops closed", result, LoopVerdict::kAccepted), true);
  html += toggle("refused", loops_label("refused", result, LoopVerdict::kRefused), false);
  html += toggle("switched-off", loops_label("switched off", result, LoopVerdict::kSwitchedOff), false);
  html += toggle("front-end", "front end alone", false, view_box_with(front_end, picture));
  html += toggle("odometry", "odometry", false, view_box_with(odometry, picture));
  html += "<div class=\"canvas\" style=\"aspect-ratio:" + std::to_string(picture.width_px) + '/' +
          std::to_string(picture.height_px) + "\">\n<svg id=\"map\" viewBox=\"" +
          view_box(0, 0, picture.width_px, picture.height_px) +
          "\" role=\"img\" aria-label=\"Map with trajectory and loops\">\n";
  html += "<image class=\"layer grid\" " + size + " href=\"data:image/png;base64," + base64(picture.png) +
          "\"/>\n";
  html += path_layer("odometry", odometry);
  html += path_layer("front-end", front_end);
  html += loop_layer("refused", result, LoopVerdict::kRefused, project);
  html += loop_layer("switched-off", result, LoopVerdict::kSwitchedOff, project);
  html += loop_layer("accepted", result, LoopVerdict::kAccepted, project);
  const Paths trajectory = paths_of(result, mapped, project);
  html += trajectory_layer(trajectory);
  html += ends_layer(trajectory) + scale_bar(picture);
  html += "</svg>\n</div>\n";
  html += "<p class=\"legend\"><span class=\"ramp\"></span> trajectory from <b>start</b> to <b>end</b>. " +
          sampling_note(result) +
          "<span class=\"hint\">Wheel zooms, dragging moves, a double click shows all.</span></p>\n</div>\n";
  return html;
}

}  // namespace psi_slam
