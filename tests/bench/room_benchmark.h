// SPDX-License-Identifier: BSD-3-Clause
// A benchmark of one small log: the simulated room, its settings, and its true relations.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "../session/room_log.h"
#include "psi_slam/base/time_stamp.h"
#include "test_files.h"

namespace psi_slam {

/// A drive of almost two rounds, and where the robot truly was; `stretch` 1 is the truth.
inline void write_room_benchmark(const std::filesystem::path& data, const std::filesystem::path& ini,
                                 double stretch = 1) {
  constexpr int kScans = 190;
  write_lines(data / "room.log", room_log_lines(kScans));
  write_file(ini / "room.ini", "[log]\n");
  std::string relations;
  for (int i = 20; i < kScans; i += 10) {
    const mrpt::math::TPose2D motion = room_pose(2 * M_PI * i / 100) - room_pose(2 * M_PI * (i - 20) / 100);
    relations += format_seconds(1'000'000'000 + 200'000 * (i - 20)) + ' ' +
                 format_seconds(1'000'000'000 + 200'000 * i) + ' ' + std::to_string(stretch * motion.x) +
                 ' ' + std::to_string(stretch * motion.y) + " 0 0 0 " + std::to_string(motion.phi) + '\n';
  }
  write_file(data / "room.relations", relations);
}

}  // namespace psi_slam
