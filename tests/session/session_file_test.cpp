// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_file.h"

#include <gmock/gmock.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "base/file_checksum.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

template <class Number>
bool same_bits(Number a, Number b) {
  return std::memcmp(&a, &b, sizeof a) == 0;
}

LaserScan scan_of(std::vector<float> ranges_m, float max_range_m) {
  LaserScan scan;
  scan.bearings_rad = std::make_shared<std::vector<float>>(ranges_m.size(), 0.1F);
  scan.ranges_m = std::move(ranges_m);
  scan.max_range_m = max_range_m;
  scan.robot_T_laser = {0.1, -1e-300, M_PI};
  scan.sweep_time_s = 0.025F;
  return scan;
}

/// Returns a scan of a second laser. For frame 2, adds a scan of a third laser.
std::vector<CompanionScan> companions_of(std::size_t frame) {
  std::vector<CompanionScan> companions(frame == 2 ? 2 : 1);
  for (std::size_t i = 0; i < companions.size(); ++i) {
    companions[i].scan = scan_of(std::vector<float>(i + 2, 2.2F), 40);
    companions[i].scan.laser = i + 1;
    companions[i].time_us = 17 + static_cast<TimeUs>(frame);
    companions[i].frame_T_robot = {1.0 / 7, -0.0, 1e-300};
  }
  return companions;
}

/// Returns a recording with scans of up to three lasers and with numbers that a text would round.
SessionRecording small_recording() {
  SessionRecording recording;
  const float nan = std::numeric_limits<float>::quiet_NaN();
  for (std::size_t i = 0; i < 4; ++i) {
    Frame frame;
    frame.index = i;
    frame.time_us = 1'000'000'000'000'007 - static_cast<TimeUs>(i);  // time stamps run backwards
    frame.odom_T_robot = {1.0 / 3, -0.0, std::nextafter(M_PI, 0)};
    frame.scan = i < 2 ? scan_of({1.1F, nan, INFINITY, 3.3F}, 80) : scan_of({0.1F}, 30);
    frame.has_odometry = i != 3;
    if (i > 1) frame.imu_heading_rad = -1.0 / 3;
    if (i > 0) frame.companions = companions_of(i);
    recording.frames.push_back(frame);
  }
  recording.facts.program_version = "0.1.0";
  recording.facts.logs = {{"first.log", std::string(64, 'a'), 3}, {"zweiter \"Lauf\".log", "", 1}};
  recording.facts.runs = {{2, {17, {0.1, 1.0 / 3, -1e-17}, {2.0 / 3, -0.0, 1e-300}}}};
  recording.facts.settings = "[run]\nseed = 7\n";
  recording.facts.edits.add({{LoopEdit::Kind::kDelete, 2, 1}, {EditTime::Kind::kAfterScan, 3}});
  recording.facts.logs[0].skipped = {2, "first.log:7: no number", 5};
  recording.facts.logs[0].broken_off = "first.log:9 is cut off";
  recording.facts.logs[1].scans_left = true;
  return recording;
}

void expect_same_scan(const LaserScan& a, const LaserScan& b) {
  EXPECT_EQ(a.laser, b.laser);
  EXPECT_TRUE(same_bits(a.robot_T_laser, b.robot_T_laser));
  EXPECT_EQ(a.max_range_m, b.max_range_m);
  EXPECT_EQ(a.sweep_time_s, b.sweep_time_s);
  EXPECT_EQ(*a.bearings_rad, *b.bearings_rad);
  ASSERT_EQ(a.ranges_m.size(), b.ranges_m.size());
  for (std::size_t beam = 0; beam < a.ranges_m.size(); ++beam)
    EXPECT_TRUE(same_bits(a.ranges_m[beam], b.ranges_m[beam]));
}

class SessionFileTest : public testing::Test {
 protected:
  void SetUp() override {
    const SessionRecording recording = small_recording();
    write_session_file(path_, recording.facts, recording.frames);
    bytes_ = read_file(path_);
  }

  std::string complaint_about(const std::string& bytes) const {
    write_file(path_, bytes);
    return sentence_of([&] { read_session_file(path_); });
  }

  /// Returns `bytes` with the checksum at the end replaced by the correct one.
  static std::string sealed(const std::string& bytes) {
    const std::string content = bytes.substr(0, bytes.size() - 64);
    return content + sha256_of_text(content);
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "my.session";
  std::string bytes_;
};

TEST_F(SessionFileTest, restores_everything_to_the_last_bit) {
  const SessionRecording before = small_recording();
  const SessionRecording back = read_session_file(path_);
  ASSERT_EQ(back.frames.size(), before.frames.size());
  for (std::size_t i = 0; i < before.frames.size(); ++i) {
    const Frame& a = before.frames[i];
    const Frame& b = back.frames[i];
    EXPECT_EQ(b.index, i);
    EXPECT_EQ(a.time_us, b.time_us);
    EXPECT_EQ(a.has_odometry, b.has_odometry);
    EXPECT_EQ(a.imu_heading_rad, b.imu_heading_rad);
    EXPECT_TRUE(same_bits(a.odom_T_robot, b.odom_T_robot));
    expect_same_scan(a.scan, b.scan);
    ASSERT_EQ(a.companions.size(), b.companions.size());
    for (std::size_t other = 0; other < a.companions.size(); ++other) {
      EXPECT_EQ(a.companions[other].time_us, b.companions[other].time_us);
      EXPECT_TRUE(same_bits(a.companions[other].frame_T_robot, b.companions[other].frame_T_robot));
      expect_same_scan(a.companions[other].scan, b.companions[other].scan);
    }
  }
  EXPECT_EQ(back.frames[0].scan.bearings_rad, back.frames[1].scan.bearings_rad)
      << "a sensor is described once";
  EXPECT_EQ(back.frames[1].companions[0].scan.bearings_rad, back.frames[3].companions[0].scan.bearings_rad);

  EXPECT_EQ(back.facts.program_version, "0.1.0");
  ASSERT_EQ(back.facts.logs.size(), 2U);
  EXPECT_EQ(back.facts.logs[0].sha256, std::string(64, 'a'));
  EXPECT_EQ(back.facts.logs[1].name, "zweiter \"Lauf\".log");
  EXPECT_EQ(back.facts.logs[1].scans, 1U);
  ASSERT_EQ(back.facts.runs.size(), 1U);
  EXPECT_EQ(back.facts.runs[0].scan, 2U);
  EXPECT_EQ(back.facts.runs[0].start.node, 17U);
  const RunStart& start = before.facts.runs[0].start;
  EXPECT_TRUE(same_bits(back.facts.runs[0].start.node_T_robot, start.node_T_robot));
  EXPECT_TRUE(same_bits(back.facts.runs[0].start.robot_T_found, start.robot_T_found));
  EXPECT_EQ(back.facts.settings, before.facts.settings);
  EXPECT_EQ(back.facts.edits.text(), before.facts.edits.text());
  for (std::size_t i = 0; i < 2; ++i) {
    const RecordedLog& log = back.facts.logs[i];
    EXPECT_EQ(log.skipped.sentence(), before.facts.logs[i].skipped.sentence());
    EXPECT_EQ(log.skipped.spare_scans, i == 0 ? 5U : 0U);
    EXPECT_EQ(log.broken_off, before.facts.logs[i].broken_off);
    EXPECT_EQ(log.scans_left, i == 1);
  }
}

TEST_F(SessionFileTest, is_deterministic_and_ends_with_its_checksum) {
  const SessionRecording recording = read_session_file(path_);
  write_session_file(path_, recording.facts, recording.frames);
  EXPECT_EQ(read_file(path_), bytes_);
  EXPECT_EQ(bytes_.substr(bytes_.size() - 64), sha256_of_text(bytes_.substr(0, bytes_.size() - 64)));
  EXPECT_TRUE(is_session_file(path_));
}

TEST_F(SessionFileTest, accepts_texts_that_are_not_utf_8) {
  SessionRecording recording = small_recording();
  recording.facts.logs[0].name = "B\xfcro.log";
  recording.facts.logs[0].skipped.first = "B\xfcro.log:7: \"\xff\" is no number";
  write_session_file(path_, recording.facts, recording.frames);
  const SessionRecording back = read_session_file(path_);
  EXPECT_EQ(back.facts.logs[0].name, "B\xef\xbf\xbdro.log");
  EXPECT_THAT(back.facts.logs[0].skipped.first, HasSubstr("is no number"));
}

TEST_F(SessionFileTest, detects_every_flipped_bit) {
  for (std::size_t i = 0; i < bytes_.size(); ++i) {
    std::string flipped = bytes_;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    EXPECT_THAT(complaint_about(flipped), HasSubstr("my.session is ")) << "byte " << i;
  }
}

TEST_F(SessionFileTest, reports_a_truncated_file) {
  for (std::size_t size = 16; size < bytes_.size(); ++size)
    EXPECT_THAT(complaint_about(bytes_.substr(0, size)), HasSubstr("my.session is cut off")) << size;
  EXPECT_THAT(complaint_about(bytes_.substr(0, 15)), HasSubstr("is not a session of psi-slam"));
}

TEST_F(SessionFileTest, reports_a_newer_version) {
  std::string newer = bytes_;
  newer[16] = 5;
  EXPECT_THAT(
      complaint_about(sealed(newer)),
      HasSubstr(
          "my.session is a session of version 5, made by a newer psi-slam. This one reads versions up to 4"));
}

TEST_F(SessionFileTest, reports_a_file_that_is_no_session) {
  EXPECT_THAT(complaint_about(""), HasSubstr("my.session is not a session of psi-slam"));
  EXPECT_THAT(complaint_about("FLASER 180 1.0 1.0 and so on, for longer than any head"),
              HasSubstr("my.session is not a session of psi-slam"));
  EXPECT_FALSE(is_session_file(path_));
  EXPECT_THAT(sentence_of([&] { read_session_file(folder_.path() / "none"); }), HasSubstr("does not exist"));
  EXPECT_THAT(sentence_of([&] { read_session_file(folder_.path()); }), HasSubstr("is a folder"));
  EXPECT_FALSE(is_session_file(folder_.path() / "none"));
}

TEST_F(SessionFileTest, reports_contradictions_despite_a_valid_checksum) {
  const SessionRecording good = small_recording();
  const auto complaint = [&](const std::function<void(SessionRecording&)>& spoil) {
    SessionRecording recording = good;
    spoil(recording);
    write_session_file(path_, recording.facts, recording.frames);
    return sentence_of([&] { read_session_file(path_); });
  };
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames.pop_back(); }), HasSubstr("do not add up"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.facts.logs.clear(); }), HasSubstr("do not add up"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.facts.runs[0].scan = 4; }), HasSubstr("a run begins"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.facts.runs[0].start.node_T_robot.y = -1.1e7; }),
              HasSubstr("a run begins at an invalid pose"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.facts.runs[0].start.robot_T_found.x = 1e300; }),
              HasSubstr("a run begins at an invalid pose"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.facts.runs[0].start.robot_T_found.phi = NAN; }),
              HasSubstr("its description is not valid JSON"))
      << "JSON cannot represent NaN";
  EXPECT_THAT(complaint([](SessionRecording& r) { r.facts.runs.push_back(r.facts.runs[0]); }),
              HasSubstr("its runs are out of order"));
  EXPECT_THAT(complaint([](SessionRecording& r) {
                r.facts.logs[0].scans = static_cast<std::size_t>(-3);
                r.facts.logs[1].scans = 7;  // the sum is 4, which is the number of frames
              }),
              HasSubstr("a log has more scans than the session"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].companions[0].frame_T_robot.x = 1e300; }),
              HasSubstr("invalid pose"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[0].odom_T_robot.phi = NAN; }),
              HasSubstr("invalid pose"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[2].imu_heading_rad = NAN; }),
              HasSubstr("the heading by a gyroscope is not finite"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[2].companions[1].scan.laser = 4'000'000'000; }),
              HasSubstr("number of a laser is too high"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[2].companions[1].scan.laser = 1; }),
              HasSubstr("out of order"));
  EXPECT_THAT(complaint([](SessionRecording& r) {
                r.frames[3].scan.bearings_rad = std::make_shared<std::vector<float>>(1, NAN);
              }),
              HasSubstr("beam bearing is not finite"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].scan.ranges_m.pop_back(); }),
              HasSubstr("another number of beams than its sensor"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].companions[0].scan.ranges_m.pop_back(); }),
              HasSubstr("another number of beams than its sensor"));
}

}  // namespace
}  // namespace psi_slam
