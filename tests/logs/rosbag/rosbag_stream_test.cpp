// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/rosbag_stream.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <functional>
#include <string>

#include "bag_files.h"
#include "log_files.h"
#include "ros1_files.h"
#include "same_frames.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;
using testing::HasSubstr;

constexpr double kLookOver_s = 0.2;

/// A kind of bag: its name and its bytes.
struct StreamKind {
  std::string name;
  std::function<void(const Path&, const Recording&)> write;
  friend void PrintTo(const StreamKind& kind, std::ostream* out) { *out << kind.name; }
};

StreamKind ros1_kind(const std::string& name, const Ros1Layout& layout) {
  return {name,
          [=](const Path& path, const Recording& recording) { write_ros1_bag(path, recording, layout); }};
}

StreamKind mcap_kind(const std::string& name, const McapLayout& layout) {
  return {name, [=](const Path& path, const Recording& recording) { write_mcap(path, recording, layout); }};
}

std::unique_ptr<LogReader> open_text(const std::string& bytes, const LogOptions& options = {}) {
  return open_rosbag_stream(std::make_unique<TextSource>(std::make_shared<std::string>(bytes), "run.bag"),
                            options, kLookOver_s);
}

class RosbagStreamTest : public testing::TestWithParam<StreamKind> {
 protected:
  Path written(const Recording& recording) const {
    const Path path = folder_.path() / "run";
    GetParam().write(path, recording);
    return path;
  }

  TemporaryFolder folder_;
};

TEST_P(RosbagStreamTest, has_the_frames_of_the_complete_bag) {
  const Path path = written(recorded_run());
  const TemporaryFolder plain;
  write_mcap(plain.path() / "run.mcap", recorded_run());
  const auto live = open_text(read_file(path));
  const auto whole = open_bag_log(plain.path() / "run.mcap", {});
  EXPECT_EQ(expect_same_frames(*live, *whole), 20U);
  EXPECT_EQ(live->assumptions(), whole->assumptions());
}

TEST_P(RosbagStreamTest, ends_where_the_bytes_end) {
  const std::string bytes = read_file(written(recorded_run()));
  const auto expected = all_frames(*open_text(bytes));
  std::size_t most = 0;
  for (std::size_t size = bytes.size() / 2; size < bytes.size(); size += 11) {
    const auto frames = all_frames(*open_text(bytes.substr(0, size)));
    ASSERT_LE(frames.size(), expected.size()) << size << " bytes";
    EXPECT_GE(frames.size(), most) << size << " bytes";
    most = frames.size();
    for (std::size_t i = 0; i < frames.size(); ++i) EXPECT_EQ(frames[i].time_us, expected[i].time_us);
  }
  EXPECT_EQ(most, expected.size());
}

INSTANTIATE_TEST_SUITE_P(Bags, RosbagStreamTest,
                         testing::Values(ros1_kind("ros1", {}), ros1_kind("ros1_lz4", {"lz4", 7, true, true}),
                                         ros1_kind("ros1_killed", {"none", 7, false, true}),
                                         ros1_kind("ros1_while_recorded", {"none", 7, false, false}),
                                         mcap_kind("mcap", {}), mcap_kind("mcap_zstd", {"zstd"}),
                                         mcap_kind("mcap_without_chunks", {"", 0})),
                         testing::PrintToStringParamName());

TEST(RosbagStream, skips_damaged_messages) {
  Recording recording = recorded_run();
  const auto scan = std::find_if(recording.rbegin(), recording.rend(), [](const Recorded& message) {
    return std::holds_alternative<RecordedScan>(message);
  });
  auto damaged = std::get<RecordedScan>(*scan);
  damaged.angle_increment_rad = 0;
  *scan = damaged;
  Ros1Writer writer({});
  for (const Recorded& message : recording) writer.add(message);
  const auto live = open_text(writer.finish());
  EXPECT_EQ(all_frames(*live).size(), 19U);
  EXPECT_EQ(live->skipped_lines().count, 1U);
  EXPECT_THAT(live->skipped_lines().first, HasSubstr("the scan's angles start at"));
}

TEST(RosbagStream, of_damaged_scans_only_is_an_error) {
  Ros1Writer writer({});
  for (Recorded message : recorded_run()) {
    if (auto* scan = std::get_if<RecordedScan>(&message)) scan->angle_increment_rad = 0;
    writer.add(message);
  }
  const auto live = open_text(writer.finish());
  EXPECT_THAT(sentence_of([&] { live->next(); }), HasSubstr("the scan's angles start at"));
  EXPECT_EQ(live->skipped_lines().count, 20U);
}

TEST(RosbagStream, of_a_compressed_chunk_that_is_being_recorded_is_an_error) {
  Ros1Writer writer({"lz4", 7, false, false});
  for (const Recorded& message : recorded_run()) writer.add(message);
  EXPECT_THAT(sentence_of([&] { open_text(writer.finish()); }),
              HasSubstr("a chunk compressed by lz4 is still being recorded"));
}

TEST(RosbagStream, waits_for_the_lasers_that_the_user_names) {
  Recording recording = recorded_run(60);
  RecordedScan late = std::get<RecordedScan>(recording[1]);
  for (const Recorded& message : recorded_run(60)) {
    const auto* scan = std::get_if<RecordedScan>(&message);
    if (scan == nullptr || scan->time_us < late.time_us + 2'000'000) continue;
    RecordedScan second = *scan;
    second.topic = "/second";
    recording.emplace_back(second);
  }
  std::stable_sort(recording.begin(), recording.end(),
                   [](const Recorded& a, const Recorded& b) { return time_of(a) < time_of(b); });
  Ros1Writer writer({});
  for (const Recorded& message : recording) writer.add(message);
  LogOptions options;
  options.scan_topic = "/second";
  EXPECT_EQ(all_frames(*open_text(writer.finish(), options)).size(), 20U);
}

TEST(RosbagStream, without_scans_is_an_error) {
  EXPECT_THAT(sentence_of([&] { open_text(""); }), HasSubstr("run.bag is empty"));
  Ros1Writer writer({});
  writer.add(static_mount());
  EXPECT_THAT(sentence_of([&] { open_text(writer.finish()); }), HasSubstr("run.bag has no laser scans"));
}

}  // namespace
}  // namespace psi_slam
