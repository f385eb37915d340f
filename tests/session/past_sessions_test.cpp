// SPDX-License-Identifier: BSD-3-Clause
// Reads a session file of every version of the format since psi-slam 0.1.0. Each still loads and gives the
// same map. A new kSessionVersion needs a new file; the old files must not change.
//
// version-3.session: two runs in the room of room_log.h, made by `psi-slam merge`. The first run has 55
// scans, 50 for each round. The second run has 48 scans, 40 for each round. It begins with the 13th scan of a
// round. Line 21 of the first log is malformed, and the log is cut off in line 57.
//
// version-4.session: the room of room_log.h again. One run of a bag without odometry has 60 scans, 50 for
// each round. A gyroscope with a bias of 0.02 rad/s gives the heading of each scan after the first.
#include <gmock/gmock.h>

#include <cmath>

#include "base/file_checksum.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/mapping_session.h"
#include "room_log.h"
#include "session/recorded_settings.h"
#include "session/session_file.h"
#include "session/session_input.h"
#include "session/settings.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

std::filesystem::path past_session(const std::string& name) {
  return std::filesystem::path(PSI_SLAM_PAST_SESSIONS) / name;
}

TEST(PastSessions, version_3_has_faults_of_each_log_and_gives_the_same_map) {
  const auto file = past_session("version-3.session");
  ASSERT_EQ(sha256_of_file(file), "65b48346934b60af846ebf12cd31d0ff81a8c03b8ab0db9b6a4da19c87629f41")
      << "the session file was changed";
  const SessionInput input = SessionInput::of_file(file);
  const SessionFacts& facts = input.recording()->facts;
  ASSERT_EQ(facts.logs.size(), 2U);
  EXPECT_EQ(facts.logs[0].scans, 55U);
  EXPECT_EQ(facts.logs[0].skipped.count, 1U);
  EXPECT_THAT(facts.logs[0].skipped.first, testing::HasSubstr("first.log:21"));
  EXPECT_EQ(facts.logs[0].skipped.spare_scans, 0U);
  EXPECT_THAT(facts.logs[0].broken_off.value_or(""), testing::HasSubstr("first.log:57"));
  EXPECT_EQ(facts.logs[1].skipped.count, 0U);
  EXPECT_FALSE(facts.logs[1].broken_off);
  EXPECT_FALSE(facts.logs[0].scans_left || facts.logs[1].scans_left);
  ASSERT_EQ(facts.runs.size(), 1U);
  BoundSettings bound;
  EXPECT_THAT(load_recorded(bound, facts, file),
              testing::ElementsAre(testing::AllOf(testing::HasSubstr("ignores obsolete options: "),
                                                  testing::HasSubstr("min_response"),
                                                  testing::HasSubstr("odometry_sigma_theta_per_turn"))));
  EXPECT_THAT(bound.table.take_warnings(), testing::IsEmpty()) << "users cannot edit a session's settings";
  MappingSession session(input, bound.settings);
  session.run(std::atomic<bool>(false));
  EXPECT_THAT(session.warnings(),
              testing::ElementsAre(testing::HasSubstr("first.log:57"), testing::HasSubstr("first.log:21")));
  EXPECT_LT(distance_m(session.result().frames.back().map_T_robot, TPose2D(0.4085, 7.9527, 0)), 0.015)
      << "the map is the same as when the session was recorded";
}

TEST(PastSessions, version_4_has_headings_by_a_gyroscope_and_gives_the_same_map) {
  const auto file = past_session("version-4.session");
  ASSERT_EQ(sha256_of_file(file), "0f105c04e9fa845c6c126b28ff9e6f0baa31f55049f1592d4e40db169124addd")
      << "the session file was changed";
  const SessionInput input = SessionInput::of_file(file);
  const std::vector<Frame>& frames = input.recording()->frames;
  ASSERT_EQ(frames.size(), 60U);
  EXPECT_FALSE(frames[0].imu_heading_rad);
  for (std::size_t i = 2; i < frames.size(); ++i) {
    EXPECT_FALSE(frames[i].has_odometry);
    const double turn_rad = frames[i].imu_heading_rad.value() - frames[i - 1].imu_heading_rad.value();
    const double true_turn_rad = (room_pose(2 * M_PI * static_cast<double>(i) / 50) -
                                  room_pose(2 * M_PI * static_cast<double>(i - 1) / 50))
                                     .phi;
    EXPECT_NEAR(turn_rad, true_turn_rad + 0.02 * 0.2, 0.01);
  }
  BoundSettings bound;
  load_recorded(bound, input.recording()->facts, file);
  MappingSession session(input, bound.settings);
  session.run(std::atomic<bool>(false));
  EXPECT_LT(distance_m(session.result().frames.back().map_T_robot, TPose2D(2.3553, 2.2963, 0)), 0.01)
      << "the map is the same as when the session was recorded";
}

}  // namespace
}  // namespace psi_slam
