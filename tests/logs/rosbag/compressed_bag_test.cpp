// SPDX-License-Identifier: BSD-3-Clause
// A compressed bag has the frames of the uncompressed bag: files that are compressed as a whole, alone or in
// the folder of rosbag2's compression mode "file", and messages that are compressed one by one.
#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

#include "bag_files.h"
#include "log_files.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;

std::vector<Frame> frames_of_plain_bag(const Recording& recording) {
  const TemporaryFolder folder;
  write_mcap(folder.path() / "run.mcap", recording);
  return frames_of(folder.path() / "run.mcap");
}

void expect_same_frames(const std::vector<Frame>& frames, const std::vector<Frame>& expected) {
  ASSERT_EQ(frames.size(), expected.size());
  for (std::size_t i = 0; i < frames.size(); ++i) {
    SCOPED_TRACE(i);
    EXPECT_EQ(frames[i].time_us, expected[i].time_us);
    EXPECT_EQ(frames[i].odom_T_robot, expected[i].odom_T_robot);
    EXPECT_EQ(frames[i].scan.robot_T_laser, expected[i].scan.robot_T_laser);
    EXPECT_EQ(frames[i].scan.ranges_m, expected[i].scan.ranges_m);
  }
}

void compress_in_place(const Path& path) {
  write_file(path, zstd_frame(read_file(path)));
}

struct Kind {
  std::string name;
  std::function<void(const Path&, const Recording&)> write;
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

/// Returns a kind of bag that is one file, compressed as a whole.
Kind file(const std::string& name, const std::function<void(const Path&, const Recording&)>& write) {
  return {name, [=](const Path& path, const Recording& recording) {
            write(path, recording);
            compress_in_place(path);
          }};
}

void write_metadata(const Path& folder, const std::string& mode, const std::vector<std::string>& names) {
  std::string metadata = "rosbag2_bagfile_information:\n  version: 5\n  compression_format: zstd\n";
  metadata += "  compression_mode: " + mode + "\n  relative_file_paths:\n";
  for (const std::string& name : names) metadata += "    - " + name + "\n";
  write_file(folder / "metadata.yaml", metadata);
}

/// Writes both halves of the recording as the files run_0 and run_1 of a folder. The metadata list them as
/// compressed files.
void write_halves(const Path& folder, const Recording& recording, const std::string& ending) {
  std::filesystem::create_directory(folder);
  const auto middle = recording.begin() + static_cast<std::ptrdiff_t>(recording.size() / 2);
  const auto write = ending == ".db3" ? [](const Path& p, const Recording& r) { write_db3(p, r); }
                                      : [](const Path& p, const Recording& r) { write_mcap(p, r); };
  write(folder / ("run_0" + ending), Recording(recording.begin(), middle));
  write(folder / ("run_1" + ending), Recording(middle, recording.end()));
  write_metadata(folder, "FILE", {"run_0" + ending + ".zstd", "run_1" + ending + ".zstd"});
}

/// Compresses a file as rosbag2 does: adds ".zstd" to its name and deletes the uncompressed file.
void compress(const Path& path) {
  write_file(path.string() + ".zstd", zstd_frame(read_file(path)));
  std::filesystem::remove(path);
}

Kind folder(const std::string& name, const std::string& ending,
            const std::function<void(const Path&)>& compress_files) {
  return {name, [=](const Path& path, const Recording& recording) {
            write_halves(path, recording, ending);
            compress_files(path);
          }};
}

void write_db3_in_wal_mode(const Path& path, const Recording& recording) {
  write_db3(path, recording);
  sqlite3* database = nullptr;
  sqlite3_open(path.c_str(), &database);
  sqlite3_exec(database, "PRAGMA journal_mode = WAL", nullptr, nullptr, nullptr);
  sqlite3_close(database);
  ASSERT_EQ(read_file(path).substr(18, 2), "\x02\x02");
}

const std::vector<Kind> kKinds{
    file("db3_file", [](const Path& p, const Recording& r) { write_db3(p, r); }),
    file("db3_file_in_wal_mode", write_db3_in_wal_mode),
    file("mcap_file", [](const Path& p, const Recording& r) { write_mcap(p, r); }),
    file("mcap_file_without_summary",
         [](const Path& p, const Recording& r) {
           write_mcap(p, r, {"lz4", 7, false, true});
         }),
    file("ros1_file", [](const Path& p, const Recording& r) { write_ros1_bag(p, r); }),
    {"db3_file_by_gzip",
     [](const Path& path, const Recording& recording) {
       write_db3(path, recording);
       write_gzipped(path, read_file(path));
     }},
    folder("db3_folder", ".db3",
           [](const Path& path) {
             compress(path / "run_0.db3");
             compress(path / "run_1.db3");
           }),
    folder("mcap_folder", ".mcap",
           [](const Path& path) {
             compress(path / "run_0.mcap");
             compress(path / "run_1.mcap");
           }),
    folder("folder_that_was_unpacked", ".db3", [](const Path&) {}),
    folder("folder_with_one_file_unpacked_and_kept", ".db3",
           [](const Path& path) {
             compress(path / "run_0.db3");
             write_file(path / "run_1.db3.zstd", "\x28\xB5\x2F\xFD");
           }),
    folder("folder_without_metadata", ".db3",
           [](const Path& path) {
             compress(path / "run_0.db3");
             std::filesystem::remove(path / "metadata.yaml");
           }),
    {"db3_folder_of_messages",
     [](const Path& path, const Recording& recording) {
       std::filesystem::create_directory(path);
       write_db3(path / "run_0.db3", recording, true, true);
       write_metadata(path, "MESSAGE", {"run_0.db3"});
     }},
    {"mcap_folder_of_messages",
     [](const Path& path, const Recording& recording) {
       std::filesystem::create_directory(path);
       write_mcap(path / "run_0.mcap", recording, {"", 0, true, true, true});
       write_metadata(path, "MESSAGE", {"run_0.mcap"});
     }},
};

class CompressedBag : public testing::TestWithParam<Kind> {};

TEST_P(CompressedBag, has_the_frames_of_the_uncompressed_bag) {
  const TemporaryFolder folder;
  const Recording recording = recorded_run(40);
  GetParam().write(folder.path() / "bag", recording);
  expect_same_frames(frames_of(folder.path() / "bag"), frames_of_plain_bag(recording));
}

INSTANTIATE_TEST_SUITE_P(Kinds, CompressedBag, testing::ValuesIn(kKinds),
                         [](const auto& tested) { return tested.param.name; });

TEST(CompressedBagFile, reports_its_progress) {
  const TemporaryFolder folder;
  const Path path = folder.path() / "run_0.db3.zstd";
  write_db3(path, recorded_run(2000));
  compress_in_place(path);
  const auto log = open_log(path);
  double before = log->progress();
  EXPECT_LT(before, 0.2);
  for (int i = 0; i < 2000; ++i) {
    ASSERT_TRUE(log->next());
    EXPECT_GE(log->progress(), before);
    before = log->progress();
    if (i == 1000) {
      EXPECT_NEAR(before, 0.5, 0.2);
    }
  }
  EXPECT_FALSE(log->next());
  EXPECT_EQ(log->progress(), 1.0);
}

TEST(CompressedBagFile, yields_the_frames_before_a_truncation) {
  const TemporaryFolder folder;
  const Recording recording = recorded_run(2000);
  const auto expected = frames_of_plain_bag(recording);
  for (const char* name : {"run_0.db3.zstd", "run_0.mcap.zstd"}) {
    SCOPED_TRACE(name);
    const Path path = folder.path() / name;
    path.string().find("db3") != std::string::npos ? write_db3(path, recording)
                                                   : write_mcap(path, recording, {"", 7, true, true});
    compress_in_place(path);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) * 2 / 3);
    const auto log = open_log(path);
    std::vector<Frame> frames;
    EXPECT_EQ(sentence_of([&] {
                while (auto frame = log->next()) frames.push_back(*frame);
              }),
              path.string() + " is cut off: its compressed data are incomplete. Fetch it again");
    EXPECT_GT(frames.size(), 1100U);
    EXPECT_LT(frames.size(), 1500U);
    // The last frames wait for odometry that was cut off.
    for (std::size_t i = 0; i + 3 < frames.size(); ++i)
      EXPECT_EQ(frames[i].scan.ranges_m, expected[i].scan.ranges_m);
  }
}

TEST(CompressedBagFile, without_a_readable_block_says_that_it_is_cut_off) {
  const TemporaryFolder folder;
  const Path path = folder.path() / "bag";
  write_halves(path, recorded_run(8), ".db3");
  compress(path / "run_0.db3");
  std::filesystem::resize_file(path / "run_0.db3.zstd", 100);
  EXPECT_EQ(
      sentence_of([&] { frames_of(path); }),
      (path / "run_0.db3.zstd").string() + " is cut off: its compressed data are incomplete. Fetch it again");
}

}  // namespace
}  // namespace psi_slam
