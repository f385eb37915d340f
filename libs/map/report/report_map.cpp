// SPDX-License-Identifier: BSD-3-Clause
#include <mrpt/math/TPoint2D.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "map/rendering/map_image.h"
#include "map/report/drawn_loops.h"
#include "map/report/html_text.h"
#include "map/report/report_sections.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using Pixel = mrpt::math::TPoint2D;  // position in the image in pixels, y downwards
using Path = std::vector<Pixel>;
using Paths = std::vector<Path>;  // one path for each run

constexpr int kImageSide_px = 2000;

Pixel pixel_of(const TPose2D& map_T_robot, const MapPicture& picture) {
  return {(map_T_robot.x - picture.x_min_m) / picture.resolution_m,
          (picture.y_max_m - map_T_robot.y) / picture.resolution_m};
}

std::string text(const Pixel& pixel) {
  return fixed_text(pixel.x, 1) + ',' + fixed_text(pixel.y, 1);
}

/// Adds a point to the path if it is at least 1.5 pixels from the last point or is the end of the path.
void extend(Path& path, const Pixel& point, bool is_end) {
  constexpr double kStep_px = 1.5;
  if (path.empty() || is_end || portable::hypot(point.x - path.back().x, point.y - path.back().y) >= kStep_px)
    path.push_back(point);
}

/// Returns the path of each run. `pose` selects the poses: in the map, of the front end, or of odometry. Each
/// path starts at the run's first pose in the map, so that drift is visible.
Paths paths_of(const MappingResult& result, TPose2D FrameRecord::*pose, const MapPicture& picture) {
  Paths paths;
  for (const FrameSpan& run : runs_of(result)) {
    if (run.begin == run.end) continue;
    const FrameRecord& first = result.frames[run.begin];
    Path path;
    for (std::size_t i = run.begin; i < run.end; ++i)
      extend(path,
             pixel_of(compose(first.map_T_robot, between(first.*pose, result.frames[i].*pose)), picture),
             i + 1 == run.end);
    paths.push_back(std::move(path));
  }
  return paths;
}

std::string path_data(Path::const_iterator begin, Path::const_iterator end) {
  std::string data;
  for (auto point = begin; point != end; ++point) data += (point == begin ? 'M' : 'L') + text(*point);
  return data;
}

std::string layer(const std::string& name, const std::string& content) {
  return "<g class=\"layer " + name + "\">\n" + content + "</g>\n";
}

std::string path_layer(const char* name, const Paths& paths) {
  std::string data;
  for (const Path& path : paths) data += path_data(path.begin(), path.end());
  return layer(name, "<path d=\"" + data + "\"/>");
}

/// Returns the colour of the point at `share` of a path, in [0, 1]: blue at the start, then violet and pink,
/// orange at the end. All are visible on light and dark background.
std::string time_colour(double share) {
  using Rgb = std::array<int, 3>;
  constexpr std::array<Rgb, 4> kStops = {{{47, 98, 235}, {139, 77, 230}, {226, 62, 140}, {247, 126, 24}}};
  const double place = std::clamp(share, 0.0, 1.0) * static_cast<double>(kStops.size() - 1);
  const auto before = std::min(static_cast<std::size_t>(place), kStops.size() - 2);
  const double u = place - static_cast<double>(before);
  std::string colour;
  for (std::size_t i = 0; i < 3; ++i)
    colour += (i == 0 ? "rgb(" : ",") +
              std::to_string(std::lround(kStops[before][i] * (1 - u) + kStops[before + 1][i] * u));
  return colour + ')';
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

/// Draws a dot that has the same size at every zoom: a line of length zero with round ends.
std::string dot(const std::string& css_class, const Pixel& at) {
  const std::string data = "d=\"M" + text(at) + "h0\"";
  return "<path class=\"rim\" " + data + "/><path class=\"" + css_class + "\" " + data + "><title>" +
         css_class + "</title></path>\n";
}

/// Draws all paths coloured by time, with dots at their starts and ends on top.
std::string trajectory_layer(const Paths& paths) {
  std::string lines;
  std::string dots;
  for (const Path& path : paths) {
    lines += coloured(path);
    if (!path.empty()) dots += dot("start", path.front()) + dot("end", path.back());
  }
  return layer("trajectory", lines + dots);
}

/// Draws the path along each stretch of unmatched scans, from the last matched scan on.
std::string unmatched_layer(const MappingResult& result, const UnmatchedScans& unmatched,
                            const MapPicture& picture) {
  std::string svg;
  for (const UnmatchedStretch& stretch : unmatched.stretches) {
    Path path;
    for (std::size_t i = stretch.first_frame - 1; i <= stretch.last_frame; ++i)
      extend(path, pixel_of(result.frames[i].map_T_robot, picture), i == stretch.last_frame);
    svg += "<path d=\"" + path_data(path.begin(), path.end()) + "\"><title>" +
           counted(stretch.scans(), "scan", "scans") + " not matched</title></path>\n";
  }
  return layer("unmatched", svg);
}

/// Draws a ring at each hot spot, and a dashed line from it to its suspect.
std::string hot_spot_layer(const std::vector<HotSpot>& spots, const MapPicture& picture) {
  constexpr double kRing_m = 0.75;
  if (spots.empty()) return {};
  std::string svg;
  for (const HotSpot& spot : spots) {
    const Pixel at = pixel_of({spot.at.x, spot.at.y, 0}, picture);
    const Pixel suspect = pixel_of({spot.suspect.at.x, spot.suspect.at.y, 0}, picture);
    svg += "<g><title>" + escape_html(hot_spot_text(spot)) + "</title><path d=\"M" + text(at) + 'L' +
           text(suspect) + "\"/><circle cx=\"" + fixed_text(at.x, 1) + "\" cy=\"" + fixed_text(at.y, 1) +
           "\" r=\"" + fixed_text(kRing_m / picture.resolution_m, 1) + "\"/></g>\n";
  }
  return layer("hot-spots", svg);
}

std::string loop_title(const LoopRecord& loop) {
  std::string title = "node " + std::to_string(loop.node) + " to local map " +
                      std::to_string(loop.local_map) + ", response " + fixed_text(loop.response, 2) + ", " +
                      searched_by(loop);
  if (loop.rejection) title += ": " + text_of(loop.rejection);
  return title;
}

using LoopFilter = bool (*)(const LoopRecord&);

/// Draws the loops that belong to a layer among `drawn`, which are indices into the result's loops.
std::string loop_layer(const std::string& name, const MappingResult& result,
                       const std::vector<std::size_t>& drawn, LoopFilter belongs, const MapPicture& picture) {
  const auto place = [&](std::size_t node) {
    return text(pixel_of(result.frames.at(result.node_frames.at(node)).map_T_robot, picture));
  };
  std::string svg;
  for (const std::size_t index : drawn) {
    const LoopRecord& loop = result.loops[index];
    if (!belongs(loop)) continue;
    svg += "<path d=\"M" + place(loop.reference) + 'L' + place(loop.node) + "\"><title>" +
           escape_html(loop_title(loop)) + "</title></path>\n";
  }
  return layer("loop " + name, svg);
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

/// Returns a viewBox that shows the image and the paths, with a margin around paths that leave the image.
std::string view_box(const MapPicture& picture, const Paths& paths) {
  constexpr double kMargin_px = 20;
  Pixel low(0, 0);
  Pixel high(picture.width_px, picture.height_px);
  for (const Path& path : paths)
    for (const Pixel& point : path) {
      low = {std::min(low.x, point.x - kMargin_px), std::min(low.y, point.y - kMargin_px)};
      high = {std::max(high.x, point.x + kMargin_px), std::max(high.y, point.y + kMargin_px)};
    }
  return fixed_text(low.x, 0) + ' ' + fixed_text(low.y, 0) + ' ' + fixed_text(high.x - low.x, 0) + ' ' +
         fixed_text(high.y - low.y, 0);
}

std::string toggle(const char* name, const std::string& label, bool shown, const std::string& view = {}) {
  const std::string id = std::string("show-") + name;
  return "<input type=\"checkbox\" id=\"" + id + "\"" + (shown ? " checked" : "") +
         (view.empty() ? "" : " data-view=\"" + view + "\"") + "><label for=\"" + id + "\">" +
         escape_html(label) + "</label>\n";
}

}  // namespace

std::string report_map(const MappingResult& result, const RunSummary& summary,
                       const mrpt::maps::COccupancyGridMap2D& grid) {
  const UnmatchedScans& unmatched = summary.unmatched;
  const std::vector<HotSpot> spots = summary.verdict ? summary.verdict->hot_spots : std::vector<HotSpot>();
  MapPictureOptions options;
  options.max_side_px = kImageSide_px;
  options.min_side_px = 1;
  options.transparent_unknown = true;
  options.scale_bar = false;
  const MapPicture picture = map_picture(grid, options);
  const Paths odometry = paths_of(result, &FrameRecord::odom_T_robot, picture);
  const Paths front_end = paths_of(result, &FrameRecord::front_end_T_robot, picture);
  const std::string width = std::to_string(picture.width_px);
  const std::string height = std::to_string(picture.height_px);

  std::string toggles;
  const std::vector<std::size_t> drawn = drawn_loops(result.loops);
  std::string loops;  // accepted loops come last and lie on top
  bool sampled = false;
  const auto add_loops = [&](const char* name, const char* label, bool shown, LoopFilter belongs) {
    const auto count =
        static_cast<std::size_t>(std::count_if(result.loops.begin(), result.loops.end(), belongs));
    sampled = sampled || count > kMaxLoopsDrawn;
    toggles += toggle(name, label + (" (" + grouped(count) + ')'), shown);
    loops = loop_layer(name, result, drawn, belongs, picture) + loops;
  };
  toggles += toggle("grid", "map", true) + toggle("trajectory", "trajectory", true);
  if (unmatched.count > 0)
    toggles += toggle("unmatched", "unmatched scans (" + grouped(unmatched.count) + ')', true);
  if (!spots.empty()) toggles += toggle("hot-spots", "places to check (" + grouped(spots.size()) + ')', true);
  add_loops("accepted", "accepted loops", true,
            [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; });
  add_loops("outlier", "loops rejected as outliers", false, is_outlier);
  add_loops("rejected", "loops rejected otherwise", false, [](const LoopRecord& loop) {
    return loop.state == LoopState::kRejected && !is_outlier(loop) && !found_nothing(loop);
  });
  toggles += toggle("front-end", "front end only", false, view_box(picture, front_end)) +
             toggle("odometry", "odometry", false, view_box(picture, odometry));

  return "<div class=\"map\">\n" + toggles + "<div class=\"canvas\" style=\"aspect-ratio:" + width + '/' +
         height + "\">\n<svg id=\"map\" viewBox=\"" + view_box(picture, {}) +
         "\" role=\"img\" aria-label=\"Map with trajectory and loops\">\n<image class=\"layer grid\" "
         "width=\"" +
         width + "\" height=\"" + height + "\" href=\"data:image/png;base64," + base64(picture.png) +
         "\"/>\n" + path_layer("odometry", odometry) + path_layer("front-end", front_end) + loops +
         unmatched_layer(result, unmatched, picture) +
         trajectory_layer(paths_of(result, &FrameRecord::map_T_robot, picture)) +
         hot_spot_layer(spots, picture) + scale_bar(picture) +
         "</svg>\n</div>\n<p class=\"legend\"><span class=\"ramp\"></span> trajectory from <b>start</b> to "
         "<b>end</b>. " +
         (sampled ? "Shows at most " + std::to_string(kMaxLoopsDrawn) +
                        " loops of each kind, and all that a person edited. "
                  : "") +
         "<span class=\"hint\">Zoom with the wheel, drag to move, double-click to show "
         "everything.</span></p>\n"
         "</div>\n";
}

}  // namespace psi_slam
