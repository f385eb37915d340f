// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <memory>
#include <thread>

#include "../../session/room_log.h"
#include "gui/replay.h"
#include "temporary_folder.h"

namespace psi_slam {

/// Snapshots of a run in the simulated room with a pillar.
class ReplayedRoom : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    const TemporaryFolder folder;
    Replay replay(write_lines(folder.path() / "room.log", room_log_lines()), {});
    replay.set_speed(0);
    while (replay.snapshot()->frames.size() < 1) {
      replay.step();
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    paused_ = replay.snapshot();
    replay.play();
    const auto ready = [&] {
      return replay.snapshot()->phase == ReplayPhase::kFinished && replay.drawn_map() &&
             replay.drawn_map()->scans == 150;
    };
    while (!ready()) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    finished_ = replay.snapshot();
    map_ = replay.drawn_map();
  }
  static void TearDownTestSuite() {
    paused_.reset();
    finished_.reset();
    map_.reset();
  }

  // A snapshot of the run, paused after the first scans.
  static inline std::shared_ptr<const ReplaySnapshot> paused_;
  static inline std::shared_ptr<const ReplaySnapshot> finished_;
  static inline std::shared_ptr<const DrawnMap> map_;
};

}  // namespace psi_slam
