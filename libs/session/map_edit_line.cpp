// SPDX-License-Identifier: BSD-3-Clause
#include "session/map_edit_line.h"

#include <cmath>
#include <sstream>
#include <vector>

#include "base/number_text.h"
#include "base/quotable_text.h"
#include "psi_slam/user_error.h"
#include "session/edit_values.h"

namespace psi_slam {
namespace {

using MapEditKind = MapEdit::Kind;

constexpr double kFarthest_m = 1e6;  // of a point from the origin, along each axis

const char* points_key(MapEditKind kind) {
  return kind == MapEditKind::kWall ? "line" : "polygon";
}

std::vector<std::string> keys_of(MapEditKind kind) {
  std::vector<std::string> keys{points_key(kind)};
  if (kind == MapEditKind::kWall) keys.emplace_back("width_m");
  if (kind == MapEditKind::kSlow) keys.insert(keys.end(), {"percent", "max_speed_mps"});
  keys.insert(keys.end(), {"frame", "scan"});
  return keys;
}

/// Reads "X,Y", two coordinates in metres. Empty for any other text.
std::optional<mrpt::math::TPoint2D> point_of(std::string_view text) {
  const std::size_t comma = text.find(',');
  if (comma == std::string_view::npos) return std::nullopt;
  const auto x = parse_number(text.substr(0, comma));
  const auto y = parse_number(text.substr(comma + 1));
  if (!x || !y || std::abs(*x) > kFarthest_m || std::abs(*y) > kFarthest_m) return std::nullopt;
  return mrpt::math::TPoint2D(*x, *y);
}

std::vector<mrpt::math::TPoint2D> points_of(const EditValues& values, const char* key, std::size_t least) {
  const std::string& text = values.text(key);
  const auto refuse = [&] {
    throw UserError(std::string(key) + "=" + quotable(text) + ": expected at least " + std::to_string(least) +
                    " points X,Y in metres, separated by semicolons, such as 0,0;2.5,0;2.5,1");
  };
  std::vector<mrpt::math::TPoint2D> points;
  std::istringstream parts(text);
  for (std::string part; std::getline(parts, part, ';');) {
    const auto point = point_of(part);
    if (!point) refuse();
    points.push_back(*point);
  }
  if (points.size() < least) refuse();
  return points;
}

/// Reads frame=X,Y,YAW in metres and degrees.
mrpt::math::TPose2D frame_of(const EditValues& values) {
  const std::string_view text = values.text("frame");
  const std::size_t comma = text.rfind(',');
  const auto point = point_of(text.substr(0, comma));
  const auto yaw_rad = comma == std::string_view::npos ? std::nullopt : parse_degrees(text.substr(comma + 1));
  if (!point || !yaw_rad)
    throw UserError("frame=" + quotable(text) +
                    ": expected the pose of the robot X,Y,YAW in metres and degrees, such as 2.5,0,90");
  return {point->x, point->y, *yaw_rad};
}

double number_in(const EditValues& values, const char* key, double most) {
  const double number = values.number(key);
  if (!(number > 0 && number <= most))
    throw UserError(std::string(key) + "=" + values.quoted(key) + ": expected a number above 0 and at most " +
                    trimmed_text(most, 0));
  return number;
}

double percent_of(const EditValues& values) {
  const double percent = values.number("percent");
  if (!(percent >= 1 && percent <= 99))
    throw UserError("percent=" + values.quoted("percent") + ": expected a number from 1 to 99");
  return percent;
}

}  // namespace

std::optional<MapEdit> parse_map_edit_line(std::string_view line) {
  std::istringstream words{std::string(line)};
  std::string verb;
  words >> verb;
  for (const auto& [text, kind] : kMapEditVerbs) {
    if (verb != text) continue;
    const EditValues values(words, keys_of(kind));
    MapEdit edit;
    edit.kind = kind;
    edit.points = points_of(values, points_key(kind), least_points(kind));
    if (values.has("frame")) edit.frame_T_robot = frame_of(values);
    if (values.has("scan")) edit.scan = values.whole("scan");
    if (values.has("scan") && !values.has("frame"))
      throw UserError("scan=" + values.quoted("scan") +
                      ": expected also frame=X,Y,YAW, the pose of the robot at this scan. Add it");
    if (values.has("width_m")) edit.width_m = number_in(values, "width_m", 100);
    if (values.has("percent")) edit.percent = percent_of(values);
    if (values.has("max_speed_mps")) edit.max_speed_mps = number_in(values, "max_speed_mps", 100);
    if (kind == MapEditKind::kSlow && values.has("percent") == values.has("max_speed_mps"))
      throw UserError(
          "slow: expected either percent or max_speed_mps. Write percent=40 or max_speed_mps=0.3");
    return edit;
  }
  return std::nullopt;
}

std::string map_edit_line(const MapEdit& edit) {
  std::string line;
  for (const auto& [text, kind] : kMapEditVerbs)
    if (kind == edit.kind) line = text;
  line += std::string(" ") + points_key(edit.kind) + '=';
  for (std::size_t i = 0; i < edit.points.size(); ++i)
    line += (i == 0 ? "" : ";") + exact_text(edit.points[i].x) + ',' + exact_text(edit.points[i].y);
  if (edit.width_m > 0) line += " width_m=" + exact_text(edit.width_m);
  if (edit.percent > 0) line += " percent=" + exact_text(edit.percent);
  if (edit.max_speed_mps > 0) line += " max_speed_mps=" + exact_text(edit.max_speed_mps);
  if (edit.frame_T_robot)
    line += " frame=" + exact_text(edit.frame_T_robot->x) + ',' + exact_text(edit.frame_T_robot->y) + ',' +
            exact_degrees_text(edit.frame_T_robot->phi);
  if (edit.scan > 0) line += " scan=" + std::to_string(edit.scan);
  return line;
}

}  // namespace psi_slam
