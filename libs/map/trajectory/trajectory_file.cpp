// SPDX-License-Identifier: BSD-3-Clause
#include "map/trajectory/trajectory_file.h"

#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "base/portable_math.h"
#include "base/text_parts.h"
#include "logs/frames/pose_operations.h"
#include "map/trajectory/text_lines.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kPlaneWords = 4;
constexpr std::size_t kTumWords = 8;
constexpr std::string_view kCsvHeader = "time_s,x_m,y_m,theta_rad";  // the first columns of trajectory.csv
constexpr TimeUs kSameTimeUs = 100;  // times that differ by fewer microseconds count as equal

/// Reads the time from word `stamp`, and x, y and theta from word `x` and the next two words.
StampedPose plane_pose(const TextLine& line, std::size_t stamp, std::size_t x) {
  return {line.time(stamp),
          {line.finite_number(x, "x in metres"), line.finite_number(x + 1, "y in metres"),
           mrpt::math::wrapToPi(line.finite_number(x + 2, "theta in radians"))}};
}

StampedPose tum_pose(const TextLine& line) {
  for (const std::size_t out_of_plane : {3, 4, 5})
    line.finite_number(out_of_plane, out_of_plane == 3 ? "tz in metres" : "a component of the quaternion");
  const double q_z = line.finite_number(6, "qz of a quaternion");
  const double q_w = line.finite_number(7, "qw of a quaternion");
  if (q_z == 0 && q_w == 0)
    throw line.error("expected a rotation about the z axis, found a quaternion with qz = qw = 0");
  return {line.time(0),
          {line.finite_number(1, "tx in metres"), line.finite_number(2, "ty in metres"),
           mrpt::math::wrapToPi(2 * portable::atan2(q_z, q_w))}};
}

StampedPose flaser_pose(const TextLine& line) {
  constexpr std::size_t kWordsBesideRanges = 2 + 9;  // "FLASER n" and the words after the ranges
  const std::size_t words = line.words.size();
  const std::size_t ranges = words < kWordsBesideRanges ? 0 : words - kWordsBesideRanges;
  if (words < kWordsBesideRanges ||
      line.finite_number(1, "the number of ranges") != static_cast<double>(ranges))
    throw line.error(
        "expected 'FLASER n', n ranges, two poses, time stamp, host and the logger's time stamp, found " +
        std::to_string(words) + " words, which does not match n");
  return plane_pose(line, 2 + ranges + 6, 2 + ranges);
}

/// Pose of a row of trajectory.csv, whose further columns have no blanks either.
StampedPose csv_pose(const TextLine& line) {
  TextLine row{line.path, line.number, {}};
  for (std::string_view rest = line.words[0]; row.words.size() < kPlaneWords && !rest.empty();) {
    const std::size_t end = std::min(rest.find(','), rest.size());
    row.words.push_back(rest.substr(0, end));
    rest.remove_prefix(std::min(end + 1, rest.size()));
  }
  if (row.words.size() < kPlaneWords)
    throw line.error("expected values of " + std::string(kCsvHeader) + ", found " +
                     counted(row.words.size(), "value"));
  return plane_pose(row, 0, 1);
}

}  // namespace

std::string tum_text(const Trajectory& trajectory) {
  std::string text;
  text.reserve(trajectory.size() * 80);
  for (const StampedPose& stamped : trajectory) {
    const auto& [x, y, yaw] = stamped.pose;
    text += format_seconds(stamped.time_us) + ' ' + fixed_text(x, 9) + ' ' + fixed_text(y, 9) + " 0 0 0 " +
            fixed_text(portable::sin(yaw / 2), 12) + ' ' + fixed_text(portable::cos(yaw / 2), 12) + '\n';
  }
  return text;
}

void write_tum(const std::filesystem::path& path, const Trajectory& trajectory) {
  write_text_atomically(path, tum_text(trajectory));
}

Trajectory read_trajectory(const std::filesystem::path& path) {
  Trajectory trajectory;
  bool first = true;
  bool carmen = false;
  bool csv = false;
  for_each_text_line(path, [&](const TextLine& line) {
    const char letter = line.words[0][0];
    if (std::exchange(first, false)) {
      carmen = letter >= 'A' && letter <= 'Z';  // messages of CARMEN begin with a capital letter
      csv = starts_with(line.words[0], kCsvHeader);
      if (csv) return;
    }
    if (csv) {
      trajectory.push_back(csv_pose(line));
    } else if (carmen) {
      if (line.words[0] == "FLASER") trajectory.push_back(flaser_pose(line));
    } else if (line.words.size() == kTumWords) {
      trajectory.push_back(tum_pose(line));
    } else if (line.words.size() == kPlaneWords) {
      trajectory.push_back(plane_pose(line, 0, 1));
    } else {
      throw line.error("expected 'timestamp x y theta' or 'timestamp tx ty tz qx qy qz qw', found " +
                       counted(line.words.size(), "word"));
    }
  });
  if (trajectory.empty())
    throw UserError(path.string() +
                    ": no pose found. Expected lines 'timestamp x y theta', lines in TUM format, the table " +
                    "trajectory.csv, or FLASER messages of CARMEN. Choose another file");
  return trajectory;
}

std::optional<PoseAtTime> pose_at_time(const Trajectory& sorted, TimeUs time_us, TimeUs max_gap_us) {
  const auto after =
      std::lower_bound(sorted.begin(), sorted.end(), time_us,
                       [](const StampedPose& pose, TimeUs time) { return pose.time_us < time; });
  const auto at = static_cast<std::size_t>(after - sorted.begin());
  if (after != sorted.begin() && time_us - std::prev(after)->time_us < kSameTimeUs)
    return PoseAtTime{std::prev(after)->pose, false, at - 1};
  if (after != sorted.end() && after->time_us - time_us < kSameTimeUs)
    return PoseAtTime{after->pose, false, at};
  if (after == sorted.begin() || after == sorted.end()) return std::nullopt;
  const StampedPose& before = *std::prev(after);
  const auto gap_us = after->time_us - before.time_us;
  if (gap_us > max_gap_us) return std::nullopt;
  const double fraction = static_cast<double>(time_us - before.time_us) / static_cast<double>(gap_us);
  return PoseAtTime{interpolate(before.pose, after->pose, fraction), true, at - 1};
}

}  // namespace psi_slam
