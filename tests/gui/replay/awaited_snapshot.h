// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that wait for a state of a replay.
#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include "gui/replay.h"

namespace psi_slam {

using SnapshotPtr = std::shared_ptr<const ReplaySnapshot>;

/// Returns the first snapshot that fulfils `expected`. Fails the test after four minutes, or if the replay
/// fails.
inline SnapshotPtr wait_for(const Replay& replay,
                            const std::function<bool(const ReplaySnapshot&)>& expected) {
  const auto limit = std::chrono::steady_clock::now() + std::chrono::minutes(4);  // sanitizers are slow
  SnapshotPtr snapshot = replay.snapshot();
  while (!expected(*snapshot)) {
    const bool over = snapshot->phase == ReplayPhase::kFailed;
    if (over || std::chrono::steady_clock::now() > limit) {
      ADD_FAILURE() << "phase " << static_cast<int>(snapshot->phase) << ", " << snapshot->frames.size()
                    << " scans, failure \"" << snapshot->failure << '"';
      break;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    snapshot = replay.snapshot();
  }
  return snapshot;
}

inline SnapshotPtr wait_for(const Replay& replay, ReplayPhase phase) {
  return wait_for(replay, [phase](const ReplaySnapshot& snapshot) { return snapshot.phase == phase; });
}

inline SnapshotPtr wait_for_export(const Replay& replay, int number) {
  return wait_for(replay, [number](const ReplaySnapshot& snapshot) {
    return snapshot.exported && snapshot.exported->number == number;
  });
}

inline SnapshotPtr wait_for_save(const Replay& replay, int number) {
  const SnapshotPtr now = wait_for(replay, [number](const ReplaySnapshot& snapshot) {
    return snapshot.saved && snapshot.saved->number == number;
  });
  EXPECT_EQ(now->saved->failure, "");
  return now;
}

}  // namespace psi_slam
