// SPDX-License-Identifier: BSD-3-Clause
// A benchmark with one small log: a run in a simulated room, its settings and its relations.
#pragma once

#include <cmath>
#include <filesystem>
#include <string>

#include "../session/room_log.h"
#include "psi_slam/time_stamp.h"
#include "test_files.h"

namespace psi_slam {

/// Line of a relations file. `motion` leads from scan `from` to scan `to`, which are 0-based indices.
inline std::string room_relation(int from, int to, const mrpt::math::TPose2D& motion) {
  return format_seconds(1'000'000'000 + 200'000 * from) + ' ' + format_seconds(1'000'000'000 + 200'000 * to) +
         ' ' + std::to_string(motion.x) + ' ' + std::to_string(motion.y) + " 0 0 0 " +
         std::to_string(motion.phi) + '\n';
}

/// Writes log, settings and relations of a run of almost two rounds. Relations are true if `stretch` is 1;
/// other values multiply their translations.
inline void write_room_benchmark(const std::filesystem::path& data, const std::filesystem::path& ini,
                                 double stretch = 1) {
  constexpr int kScans = 190;
  write_lines(data / "room.log", room_log_lines(kScans));
  write_file(ini / "room.ini", "[log]\n");
  std::string relations;
  for (int i = 20; i < kScans; i += 10) {
    const mrpt::math::TPose2D motion = room_pose(2 * M_PI * i / 100) - room_pose(2 * M_PI * (i - 20) / 100);
    relations += room_relation(i - 20, i, {stretch * motion.x, stretch * motion.y, motion.phi});
  }
  write_file(data / "room.relations", relations);
}

/// Writes relations between scans of the second round and scans almost one round earlier. The x component of
/// each relation is wrong by `lie_m` metres.
inline void write_room_passes(const std::filesystem::path& data, double lie_m = 0) {
  std::string relations;
  for (int i = 100; i < 190; i += 3) {
    mrpt::math::TPose2D motion = room_pose(2 * M_PI * i / 100) - room_pose(2 * M_PI * (i - 98) / 100);
    motion.x += lie_m;
    relations += room_relation(i - 98, i, motion);
  }
  write_file(data / "room.relations", relations);
}

}  // namespace psi_slam
