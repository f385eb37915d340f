// SPDX-License-Identifier: BSD-3-Clause
// A CARMEN log of a robot that drives in rounds through a room with a pillar and a niche, for tests of whole
// runs. Tests may replace single lines.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

namespace psi_slam {

inline constexpr int kRoomBeams = 181;
inline constexpr double kRoomNoReturn_m = 81.83;

struct RoomWall {
  double x0, y0, x1, y1;
};

/// Distance in metres from a point to the nearest wall in a direction. The room is closed.
inline double room_range_m(double x, double y, double direction_rad) {
  static constexpr std::array<RoomWall, 12> kWalls{{{0, 0, 12, 0},
                                                    {12, 0, 12, 8},
                                                    {12, 8, 7, 8},
                                                    {7, 8, 7, 9.5},
                                                    {7, 9.5, 4, 9.5},
                                                    {4, 9.5, 4, 8},
                                                    {4, 8, 0, 8},
                                                    {0, 8, 0, 0},
                                                    {5, 3.4, 7, 3},
                                                    {7, 3, 7.4, 4.6},
                                                    {7.4, 4.6, 5.2, 5},
                                                    {5.2, 5, 5, 3.4}}};
  const double dx = std::cos(direction_rad);
  const double dy = std::sin(direction_rad);
  double nearest_m = std::numeric_limits<double>::infinity();
  for (const RoomWall& wall : kWalls) {
    const double wx = wall.x1 - wall.x0;
    const double wy = wall.y1 - wall.y0;
    const double determinant = dx * wy - dy * wx;
    if (std::abs(determinant) < 1e-12) continue;
    const double along_beam = ((wall.x0 - x) * wy - (wall.y0 - y) * wx) / determinant;
    const double along_wall = ((wall.x0 - x) * dy - (wall.y0 - y) * dx) / determinant;
    if (along_beam > 0 && along_wall >= 0 && along_wall <= 1) nearest_m = std::min(nearest_m, along_beam);
  }
  return nearest_m;
}

/// True pose of the robot in the room, on an ellipse around the pillar. `turn_rad` is the angle on the
/// ellipse.
inline mrpt::math::TPose2D room_pose(double turn_rad) {
  const double x = 6.2 + 4 * std::cos(turn_rad);
  const double y = 4 + 2.6 * std::sin(turn_rad);
  return {x, y, std::atan2(2.6 * std::cos(turn_rad), -4 * std::sin(turn_rad))};
}

/// Returns the FLASER lines of a run with five scans a second. `scans_a_round` scans make one round. The
/// rotations of odometry are 2 % too large.
inline std::vector<std::string> room_log_lines(int scans = 150, int scans_a_round = 100) {
  std::vector<std::string> lines;
  mrpt::math::TPose2D odom_T_robot(0, 0, 0);
  for (int i = 0; i < scans; ++i) {
    const mrpt::math::TPose2D pose = room_pose(2 * M_PI * i / scans_a_round);
    if (i > 0) {
      mrpt::math::TPose2D motion = pose - room_pose(2 * M_PI * (i - 1) / scans_a_round);
      motion.phi *= 1.02;
      odom_T_robot = odom_T_robot + motion;
    }
    std::string line = "FLASER " + std::to_string(kRoomBeams);
    char text[160];
    for (int beam = 0; beam < kRoomBeams; ++beam) {
      const double bearing_rad = -M_PI / 2 + M_PI * beam / (kRoomBeams - 1);
      std::snprintf(text, sizeof text, " %.3f", room_range_m(pose.x, pose.y, pose.phi + bearing_rad));
      line += text;
    }
    std::snprintf(text, sizeof text, " %.6f %.6f %.6f %.6f %.6f %.6f %.6f robot %.6f", odom_T_robot.x,
                  odom_T_robot.y, odom_T_robot.phi, odom_T_robot.x, odom_T_robot.y, odom_T_robot.phi,
                  1000 + 0.2 * i, 0.2 * i);
    lines.push_back(line + text);
  }
  return lines;
}

/// Returns the FLASER lines of a run that stops after `before` scans, stands for `standing` scans, and drives
/// on for `after` scans.
inline std::vector<std::string> standing_log_lines(int before, int standing, int after) {
  std::vector<std::string> lines;
  int scan = 0;
  const auto add = [&](const std::string& line) {
    char stamp[64];
    const std::string without_stamps = line.substr(0, line.rfind(' ', line.rfind(" robot ") - 1));
    std::snprintf(stamp, sizeof stamp, " %.6f robot %.6f", 1000 + 0.2 * scan, 0.2 * scan);
    lines.push_back(without_stamps + stamp);
    ++scan;
  };
  const std::vector<std::string> moving = room_log_lines(before + after);
  for (int i = 0; i < before + after; ++i)
    for (int repetition = 0; repetition < (i + 1 == before ? standing : 1); ++repetition)
      add(moving[static_cast<std::size_t>(i)]);
  return lines;
}

/// Returns the words of a line, which is split at blanks.
inline std::vector<std::string> words_of(const std::string& line) {
  std::vector<std::string> words(1);
  for (const char c : line) {
    if (c == ' ')
      words.emplace_back();
    else
      words.back() += c;
  }
  return words;
}

/// Returns a FLASER line with the ranges of the beams [first, last) replaced by `range`.
inline std::string with_ranges(const std::string& line, int first, int last, const std::string& range) {
  std::vector<std::string> words = words_of(line);
  std::string result;
  for (std::size_t i = 0; i < words.size(); ++i) {
    const int beam = static_cast<int>(i) - 2;
    result += (i == 0 ? "" : " ") + (beam >= first && beam < last ? range : words[i]);
  }
  return result;
}

inline std::filesystem::path write_lines(const std::filesystem::path& path,
                                         const std::vector<std::string>& lines) {
  std::ofstream file(path);
  for (const std::string& line : lines) file << line << '\n';
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
  return path;
}

}  // namespace psi_slam
