// SPDX-License-Identifier: BSD-3-Clause
#include "session/knowledge_line.h"

#include <cmath>
#include <map>
#include <sstream>

#include "base/number_text.h"
#include "base/quotable_text.h"
#include "psi_slam/user_error.h"
#include "session/edit_values.h"

namespace psi_slam {
namespace {

constexpr double kFarthestCoordinate_m = 2e5;  // coordinates of grid maps are 32-bit floats
// The pose graph multiplies the inverse squares of deviations, which smaller deviations would overflow.
constexpr double kLeastSigma = 1e-6;  // metres or degrees
constexpr double kLargestSigma_m = 1e3;
constexpr double kLargestSigma_deg = 180;

/// Reads a standard deviation, in the unit of the key.
double stated_sigma(const EditValues& values, const char* key, const char* unit, double largest) {
  const double value = values.number(key);
  if (!(value >= kLeastSigma && value <= largest))
    throw UserError(std::string(key) + "=" + values.quoted(key) + ": expected a number of " + unit +
                    " from " + trimmed_text(kLeastSigma, 6) + " to " + trimmed_text(largest, 0) +
                    ". State the standard deviation of the measurement");
  return value;
}

TimeUs stated_time(const EditValues& values) {
  const auto time_us = parse_seconds(values.text("time_s"));
  if (!time_us)
    throw UserError("time_s=" + values.quoted("time_s") + ": expected seconds, as trajectory.csv lists them");
  return *time_us;
}

std::size_t from_scan_of(const EditValues& values) {
  return values.has("from_scan") ? values.whole("from_scan") : 0;
}

double coordinate(const EditValues& values, const char* key) {
  const double value = values.number(key);
  if (std::abs(value) > kFarthestCoordinate_m)
    throw UserError(std::string(key) + "=" + values.quoted(key) + ": expected a number of metres from -" +
                    trimmed_text(kFarthestCoordinate_m, 0) + " to " + trimmed_text(kFarthestCoordinate_m, 0) +
                    ", because coordinates of grid maps have 32 bits. Subtract a constant");
  return value;
}

/// Reads a pose with its errors. A heading needs its error.
MeasuredPose measured(const EditValues& values, const char* x, const char* y) {
  MeasuredPose measured;
  measured.pose = {coordinate(values, x), coordinate(values, y), 0};
  measured.sigma_m = stated_sigma(values, "sigma_m", "metres", kLargestSigma_m);
  if (values.has("yaw_deg") != values.has("sigma_deg"))
    throw UserError(
        "expected both yaw_deg and its standard deviation sigma_deg, or none of them if the heading is "
        "unknown. Add or remove one");
  if (!values.has("yaw_deg")) return measured;
  measured.pose.phi = values.number("yaw_deg", parse_degrees);
  stated_sigma(values, "sigma_deg", "degrees", kLargestSigma_deg);
  measured.sigma_rad = values.number("sigma_deg", parse_degrees);
  return measured;
}

std::string text_of(const MeasuredPose& measured, const char* x, const char* y) {
  std::string text =
      std::string(" ") + x + '=' + exact_text(measured.pose.x) + ' ' + y + '=' + exact_text(measured.pose.y);
  if (measured.sigma_rad) text += " yaw_deg=" + exact_degrees_text(measured.pose.phi);
  text += " sigma_m=" + exact_text(measured.sigma_m);
  if (measured.sigma_rad) text += " sigma_deg=" + exact_degrees_text(*measured.sigma_rad);
  return text;
}

std::string text_of_time(TimeUs time_us, std::size_t from_scan) {
  std::string text = " time_s=" + format_seconds(time_us);
  if (from_scan > 0) text += " from_scan=" + std::to_string(from_scan);
  return text;
}

}  // namespace

bool parse_knowledge_line(std::string_view line, const std::string& place, FixedKnowledge& knowledge) {
  std::istringstream words{std::string(line)};
  std::string verb;
  words >> verb;
  if (verb == "pose") {
    const EditValues values(words, {"time_s", "x_m", "y_m", "yaw_deg", "sigma_m", "sigma_deg", "from_scan"});
    knowledge.poses.push_back(
        {stated_time(values), measured(values, "x_m", "y_m"), from_scan_of(values), place});
  } else if (verb == "tag") {
    const EditValues values(words, {"name", "x_m", "y_m", "yaw_deg", "sigma_m", "sigma_deg"});
    knowledge.tags.push_back({values.text("name"), measured(values, "x_m", "y_m"), place});
  } else if (verb == "seen") {
    const EditValues values(
        words, {"name", "time_s", "ahead_m", "left_m", "yaw_deg", "sigma_m", "sigma_deg", "from_scan"});
    knowledge.sightings.push_back({values.text("name"), stated_time(values),
                                   measured(values, "ahead_m", "left_m"), from_scan_of(values), place});
  } else {
    return false;
  }
  return true;
}

std::string knowledge_lines(const FixedKnowledge& knowledge) {
  std::string lines;
  for (const KnownPose& pose : knowledge.poses)
    lines +=
        "pose" + text_of_time(pose.time_us, pose.from_scan) + text_of(pose.site_T_robot, "x_m", "y_m") + '\n';
  for (const TagPlace& tag : knowledge.tags)
    lines += "tag name=" + tag.name + text_of(tag.site_T_tag, "x_m", "y_m") + '\n';
  for (const TagSighting& sighting : knowledge.sightings)
    lines += "seen name=" + sighting.name + text_of_time(sighting.time_us, sighting.from_scan) +
             text_of(sighting.robot_T_tag, "ahead_m", "left_m") + '\n';
  return lines;
}

void check_tags(const FixedKnowledge& knowledge) {
  std::map<std::string, const TagPlace*> places;
  for (const TagPlace& tag : knowledge.tags) {
    const TagPlace& known = *places.emplace(tag.name, &tag).first->second;
    if (text_of(known.site_T_tag, "x_m", "y_m") != text_of(tag.site_T_tag, "x_m", "y_m"))
      throw UserError("tag " + quotable(tag.name) + " has two places, at " + known.source + " and at " +
                      tag.source + ", expected one. Remove one of the lines");
  }
}

}  // namespace psi_slam
