// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Expects that two runs gave the same poses and graph by the same searches, and the same loops.
inline void expect_same_map(const MappingResult& a, const MappingResult& b) {
  ASSERT_EQ(a.frames.size(), b.frames.size());
  for (std::size_t i = 0; i < a.frames.size(); ++i) {
    ASSERT_EQ(a.frames[i].map_T_robot, b.frames[i].map_T_robot) << "scan " << i;
    ASSERT_EQ(a.frames[i].psi, b.frames[i].psi) << "scan " << i;
    ASSERT_EQ(a.frames[i].eta, b.frames[i].eta) << "scan " << i;
    ASSERT_EQ(a.frames[i].evaluations, b.frames[i].evaluations) << "scan " << i;
    ASSERT_EQ(a.frames[i].loops_accepted, b.frames[i].loops_accepted) << "scan " << i;
    ASSERT_EQ(a.frames[i].matcher, b.frames[i].matcher) << "scan " << i;
  }
  ASSERT_EQ(a.node_frames, b.node_frames);
  ASSERT_EQ(a.graph.poses(), b.graph.poses());
  ASSERT_EQ(a.later_run_frames, b.later_run_frames);
  ASSERT_EQ(a.interruptions.size(), b.interruptions.size());
  for (std::size_t i = 0; i < a.interruptions.size(); ++i) {
    ASSERT_EQ(a.interruptions[i].frame, b.interruptions[i].frame);
    ASSERT_EQ(a.interruptions[i].found_frame, b.interruptions[i].found_frame);
  }
  ASSERT_EQ(a.unmet_edits, b.unmet_edits);
  ASSERT_EQ(a.loops.size(), b.loops.size());
  for (std::size_t i = 0; i < a.loops.size(); ++i) {
    ASSERT_EQ(a.loops[i].node, b.loops[i].node) << "loop " << i;
    ASSERT_EQ(a.loops[i].local_map, b.loops[i].local_map) << "loop " << i;
    ASSERT_EQ(a.loops[i].anchor_T_node, b.loops[i].anchor_T_node) << "loop " << i;
    ASSERT_EQ(a.loops[i].state, b.loops[i].state) << "loop " << i;
  }
}

}  // namespace psi_slam
