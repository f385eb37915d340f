// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_file.h"

#include <gmock/gmock.h>

#include <cmath>

#include "base/file_checksum.h"
#include "decompression_bombs.h"
#include "session/session_content.h"
#include "small_recording.h"
#include "temporary_folder.h"
#include "test_files.h"
#include "zstd_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

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
  for (std::size_t i = 0; i < before.frames.size(); ++i) expect_same_frame(before.frames[i], back.frames[i]);
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

TEST_F(SessionFileTest, reports_a_newer_or_too_old_version) {
  std::string other = bytes_;
  other[16] = 5;
  EXPECT_THAT(
      complaint_about(sealed(other)),
      HasSubstr(
          "my.session is a session of version 5, made by a newer psi-slam. This one reads versions up to 4"));
  other[16] = 2;
  EXPECT_THAT(complaint_about(sealed(other)), HasSubstr("of version 2, made by a psi-slam before 0.1.0"));
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
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[2].time_us = kMostTimeUs + 1; }),
              HasSubstr("a scan has an impossible time stamp"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].companions[0].time_us = INT64_MIN; }),
              HasSubstr("a scan has an impossible time stamp"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].companions[0].frame_T_robot.x = 2000; }),
              HasSubstr("the robot moves by more than 100 m between the scans of a frame"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[2].scan.robot_T_laser.y = -1e6; }),
              HasSubstr("a laser is more than 100 m from the robot's centre"));
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
              HasSubstr("a beam bearing is not finite or more than three turns"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].scan.ranges_m.pop_back(); }),
              HasSubstr("another number of beams than its sensor"));
  EXPECT_THAT(complaint([](SessionRecording& r) { r.frames[1].companions[0].scan.ranges_m.pop_back(); }),
              HasSubstr("another number of beams than its sensor"));
}

TEST_F(SessionFileTest, refuses_readings_that_no_laser_measures) {
  const auto complaint = [&](const std::function<void(LaserScan&)>& spoil, bool companion = false) {
    SessionRecording recording = small_recording();
    spoil(companion ? recording.frames[1].companions[0].scan : recording.frames[0].scan);
    write_session_file(path_, recording.facts, recording.frames);
    return sentence_of([&] { read_session_file(path_); });
  };
  for (const float range_m : {-1.0F, -1e30F, -INFINITY}) {
    EXPECT_THAT(complaint([&](LaserScan& scan) { scan.ranges_m[0] = range_m; }),
                HasSubstr("my.session is damaged: a scan has a negative range"));
    EXPECT_THAT(complaint([&](LaserScan& scan) { scan.ranges_m[1] = range_m; }, true),
                HasSubstr("a scan has a negative range"));
  }
  EXPECT_THAT(complaint([](LaserScan& scan) {
                scan.bearings_rad = std::make_shared<std::vector<float>>(scan.ranges_m.size(), 1e9F);
              }),
              HasSubstr("a beam bearing is not finite or more than three turns"));
  for (const float range_m : {-1.0F, NAN, INFINITY})
    EXPECT_THAT(complaint([&](LaserScan& scan) { scan.max_range_m = range_m; }),
                HasSubstr("the maximum range of a laser is not between 0 and 10 km"));
  EXPECT_THAT(complaint([](LaserScan& scan) { scan.sweep_time_s = NAN; }),
              HasSubstr("the sweep time of a laser is not finite"));
}

TEST_F(SessionFileTest, refuses_content_that_unpacks_to_gigabytes) {
  constexpr std::uint64_t kGigabytes = 3'000'000'000;
  const std::string packed = frame_of_zeros(kGigabytes);
  const auto with_size = [&](std::uint64_t size) {
    std::string bytes = bytes_.substr(0, 20);  // the magic bytes and the version
    append_number(bytes, std::uint64_t{packed.size()});
    append_number(bytes, size);
    return sealed(bytes + packed + std::string(64, ' '));
  };
  expect_little_memory([&] {
    EXPECT_THAT(complaint_about(with_size(kGigabytes)),
                HasSubstr("which no session of its size needs. Use a copy of it, or map the log again"));
    EXPECT_THAT(complaint_about(with_size(200'000'000)),
                HasSubstr("its data decompress to more than the expected 200000000 bytes"));
  });
}

TEST_F(SessionFileTest, refuses_small_content_of_countless_empty_scans) {
  SessionRecording recording = small_recording();
  recording.facts.runs.clear();
  Frame empty = recording.frames[0];
  empty.companions.clear();
  empty.scan.bearings_rad = std::make_shared<std::vector<float>>();
  empty.scan.ranges_m.clear();
  std::string frames;
  FrameWriter writer;
  writer.append(frames, empty);
  const std::size_t first = frames.size();
  writer.append(frames, empty);
  constexpr std::uint64_t kScans = 4'000'000;
  recording.facts.logs.resize(1);
  recording.facts.logs[0].scans = kScans;
  const std::string facts = facts_text(recording.facts);
  std::string content;
  append_number(content, std::uint64_t{facts.size()});
  content += facts;
  append_number(content, kScans);
  content += frames.substr(0, first);
  for (std::uint64_t i = 1; i < kScans; ++i) content += frames.substr(first);
  const std::string packed = zstd_frame(content);
  std::string bytes = bytes_.substr(0, 20);
  append_number(bytes, std::uint64_t{packed.size()});
  append_number(bytes, std::uint64_t{content.size()});
  EXPECT_THAT(complaint_about(sealed(bytes + packed + std::string(64, ' '))),
              HasSubstr("which no session of its size needs"));
}

}  // namespace
}  // namespace psi_slam
