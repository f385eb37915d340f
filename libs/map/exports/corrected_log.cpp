// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/corrected_log.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using mrpt::math::TPose2D;

constexpr const char* kHost = "psi-slam";
constexpr std::size_t kBytesPerWrite = std::size_t{1} << 20;

/// Returns whether the beams run clockwise, as those of a laser mounted upside down. FLASER lines state no
/// bearings: their ranges are counter-clockwise.
bool runs_clockwise(const LaserScan& scan) {
  return scan.bearings_rad && scan.bearings_rad->size() > 1 &&
         scan.bearings_rad->front() > scan.bearings_rad->back();
}

// CARMEN's names of the two lasers that have messages with poses.
constexpr std::array<const char*, 2> kMessages{"FLASER", "RLASER"};
constexpr std::array<const char*, 2> kPositions{"front", "rear"};

/// PARAM lines and comments with the mount and the bearings of a laser, which its scan lines cannot hold.
std::string parameters(const LaserScan& scan) {
  const auto& mount = scan.robot_T_laser;
  const std::string position = kPositions.at(scan.laser);
  const std::string param = "PARAM robot_" + position + "laser_";
  std::string text = "# " + (scan.laser == 0 ? "" : position + ' ') + "laser on the robot: x " +
                     fixed_text(mount.x, 6) + " m, y " + fixed_text(mount.y, 6) + " m, yaw " +
                     fixed_text(mount.phi, 6) + " rad\n";
  text += param + "offset " + fixed_text(mount.x, 6) + '\n';
  text += param + "side_offset " + fixed_text(mount.y, 6) + '\n';
  text += param + "angular_offset " + fixed_text(mount.phi, 9) + '\n';
  text += "PARAM robot_" + position + "_laser_max " + shortest_text(scan.max_range_m) + '\n';
  if (scan.bearings_rad && scan.bearings_rad->size() > 1) {
    const std::size_t beams = scan.bearings_rad->size();
    double first = static_cast<double>(scan.bearings_rad->front()) * (180 / M_PI);
    double last = static_cast<double>(scan.bearings_rad->back()) * (180 / M_PI);
    if (runs_clockwise(scan)) std::swap(first, last);
    text += "# beams: " + std::to_string(beams) + ", from " + fixed_text(first, 4) + " to " +
            fixed_text(last, 4) + " degrees\n";
    text += "PARAM laser_" + position + "_laser_resolution " +
            fixed_text((last - first) / static_cast<double>(beams - 1), 4) + '\n';
  }
  return text;
}

std::string heading(const std::vector<Frame>& log, const FrameSpan& run) {
  std::array<const LaserScan*, kMessages.size()> first{};
  for (std::size_t i = run.begin; i < run.end; ++i)
    for_each_scan(log[i], {}, [&](const LaserScan& scan, const TPose2D&) {
      if (scan.laser < first.size() && first[scan.laser] == nullptr) first[scan.laser] = &scan;
    });
  std::string text = "# corrected log: FLASER n ranges  x y theta (map)  odom_x odom_y odom_theta  ";
  text += "timestamp host logger_timestamp\n";
  if (first[1] != nullptr) text += "# RLASER: the same fields for the second laser\n";
  for (const LaserScan* scan : first)
    if (scan != nullptr) text += parameters(*scan);
  return text;
}

void append_pose(std::string& line, const TPose2D& pose) {
  for (const double value : {pose.x, pose.y, pose.phi}) line += ' ' + fixed_text(value, 9);
}

std::string scan_line(const LaserScan& scan, TimeUs time_us, const TPose2D& map_T_robot,
                      const TPose2D& odom_T_robot) {
  if (scan.laser >= kMessages.size() || scan.ranges_m.empty()) return {};
  std::vector<float> ranges_m = scan.ranges_m;
  if (runs_clockwise(scan)) std::reverse(ranges_m.begin(), ranges_m.end());
  std::string line = std::string(kMessages[scan.laser]) + ' ' + std::to_string(ranges_m.size());
  for (const float range_m : ranges_m)
    line += std::isnan(range_m) ? " 0" : ' ' + shortest_text(std::min(range_m, scan.max_range_m));
  append_pose(line, map_T_robot);
  append_pose(line, odom_T_robot);
  const std::string stamp = format_seconds(time_us);
  line += ' ' + stamp + ' ' + kHost + ' ' + stamp + '\n';
  return line;
}

std::string scan_lines(const Frame& frame, const TPose2D& map_T_robot) {
  std::string lines = scan_line(frame.scan, frame.time_us, map_T_robot, frame.odom_T_robot);
  for (const CompanionScan& companion : frame.companions)
    lines += scan_line(companion.scan, companion.time_us, compose(map_T_robot, companion.frame_T_robot),
                       compose(frame.odom_T_robot, companion.frame_T_robot));
  return lines;
}

}  // namespace

void write_corrected_log(const fs::path& path, const std::vector<Frame>& log,
                         const std::vector<TPose2D>& map_T_robot, const std::optional<FrameSpan>& run) {
  if (log.size() != map_T_robot.size())
    throw std::invalid_argument("write_corrected_log: " + std::to_string(log.size()) + " scans but " +
                                std::to_string(map_T_robot.size()) + " poses");
  const FrameSpan span = run.value_or(FrameSpan{0, log.size()});
  AtomicFile file(path);
  std::string text;
  if (span.begin < span.end) text = heading(log, span);
  for (std::size_t i = span.begin; i < span.end; ++i) {
    text += scan_lines(log[i], map_T_robot[i]);
    if (text.size() < kBytesPerWrite) continue;
    file.write(text);
    text.clear();
  }
  file.write(text);
  file.move_into_place();
}

}  // namespace psi_slam
