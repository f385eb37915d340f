// SPDX-License-Identifier: BSD-3-Clause
#include "live/growing_folder.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "bag_files.h"
#include "live/live_source.h"
#include "log_files.h"
#include "other_process.h"
#include "psi_slam/open_log.h"
#include "same_frames.h"
#include "sender.h"
#include "temporary_folder.h"
#include "test_files.h"
#include "zstd_files.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;
using namespace std::chrono_literals;
using testing::HasSubstr;

constexpr int kScans = 60;
constexpr std::size_t kFiles = 3;

/// A part of a recording, which begins with the static transform as each file of rosbag2 does.
Recording part_of(const Recording& recording, std::size_t number) {
  const std::size_t size = recording.size() / kFiles;
  const auto begin = recording.begin() + static_cast<std::ptrdiff_t>(number * size);
  Recording part(begin, number + 1 == kFiles ? recording.end() : begin + static_cast<std::ptrdiff_t>(size));
  if (number > 0) part.insert(part.begin(), static_mount());
  return part;
}

std::string metadata(const std::vector<std::string>& files) {
  std::string text = "rosbag2_bagfile_information:\n  version: 5\n  relative_file_paths:\n";
  for (const std::string& file : files) text += "    - " + file + '\n';
  return text;
}

/// Records as rosbag2 does, in the folder of a bag.
class FolderRecorder {
 public:
  FolderRecorder(Path folder, std::string ending, bool compresses)
      : folder_(std::move(folder)), ending_(std::move(ending)), compresses_(compresses) {}

  void record(const Recording& recording) {
    std::vector<std::string> names;
    for (std::size_t i = 0; i < kFiles; ++i) {
      const std::string name = "run_" + std::to_string(i) + ending_;
      ending_ == ".db3" ? write_database(folder_ / name, part_of(recording, i))
                        : write_records(folder_ / name, part_of(recording, i));
      names.push_back(name + (compresses_ ? ".zstd" : ""));
      if (!compresses_) continue;
      write_file(folder_ / (name + ".zstd"), zstd_frame(read_file(folder_ / name)));
      std::filesystem::remove(folder_ / name);
    }
    const std::string text = metadata(names);
    write_file(folder_ / "metadata.yaml", text.substr(0, text.size() / 2));
    std::this_thread::sleep_for(20ms);
    write_file(folder_ / "metadata.yaml", text);
    if (last_bytes_.empty()) return;
    std::this_thread::sleep_for(20ms);  // rosbag2 ends the last MCAP file after it has written metadata.yaml
    std::ofstream(last_file_, std::ios::app) << last_bytes_;
  }

 private:
  static void write_database(const Path& file, const Recording& part) {
    Db3Writer writer(file, {"journal_mode=MEMORY", "synchronous=OFF"});
    writer.create_tables();
    for (std::size_t i = 0; i < part.size();) {
      writer.begin();
      for (const std::size_t end = std::min(i + 10, part.size()); i < end; ++i)
        writer.add(part[i], cdr(part[i]));
      writer.commit();
      std::this_thread::sleep_for(5ms);
    }
  }

  /// The end of a file is written after the next file has begun.
  void write_records(const Path& file, const Recording& part) {
    McapBytesWriter writer({});
    for (const Recorded& message : part) writer.add(message);
    const std::string bytes = writer.finish();
    const std::size_t half = bytes.size() / 2;
    const std::size_t most = bytes.size() - 400;
    write_file(file, bytes.substr(0, half));
    if (!last_bytes_.empty()) std::ofstream(last_file_, std::ios::app) << last_bytes_;
    std::this_thread::sleep_for(20ms);
    std::ofstream(file, std::ios::app) << bytes.substr(half, compresses_ ? std::string::npos : most - half);
    last_bytes_ = compresses_ ? "" : bytes.substr(most);
    last_file_ = file;
  }

  Path folder_;
  std::string ending_;
  bool compresses_;
  Path last_file_;
  std::string last_bytes_;  // bytes that are not written yet
};

class GrowingFolderTest : public testing::Test {
 protected:
  LiveInput input(std::optional<double> idle_s = std::nullopt) const {
    LiveInput input;
    input.kind = LiveInput::Kind::kFollow;
    input.file = folder_.path().string();
    input.idle_s = idle_s;
    input.look_over_s = 0.2;
    return input;
  }
  static LiveControl control() {
    return {[] { return false; }, [](const std::string&) {}};
  }

  TemporaryFolder folder_;
};

struct FolderKind {
  std::string ending;
  bool compresses = false;  ///< each file after it was closed
};

class RecordedFolder : public GrowingFolderTest, public testing::WithParamInterface<FolderKind> {};

TEST_P(RecordedFolder, has_the_frames_of_the_complete_bag) {
  OtherProcess recorder([&] {
    std::this_thread::sleep_for(20ms);
    FolderRecorder(folder_.path(), GetParam().ending, GetParam().compresses).record(recorded_run(kScans));
  });
  const auto live = open_live(input(), {}, control());
  std::vector<Frame> frames;
  while (auto frame = live->next()) frames.push_back(*std::move(frame));
  EXPECT_TRUE(recorder.succeeds());
  const auto whole = open_log(folder_.path());
  ASSERT_EQ(frames.size(), static_cast<std::size_t>(kScans));
  for (const Frame& frame : frames) {
    const auto expected = whole->next();
    ASSERT_TRUE(expected);
    EXPECT_EQ(bytes_of_frame(frame), bytes_of_frame(*expected)) << frame.index;
  }
  EXPECT_FALSE(whole->next());
  EXPECT_EQ(live->skipped_lines().count, 0U);
}

INSTANTIATE_TEST_SUITE_P(Kinds, RecordedFolder,
                         testing::Values(FolderKind{".db3"}, FolderKind{".mcap"}, FolderKind{".db3", true},
                                         FolderKind{".mcap", true}),
                         [](const auto& kind) {
                           return kind.param.ending.substr(1) + (kind.param.compresses ? "_zstd" : "");
                         });

TEST_F(GrowingFolderTest, ends_when_nothing_comes) {
  write_db3(folder_.path() / "run_0.db3", part_of(recorded_run(kScans), 0));
  write_mcap(folder_.path() / "run_1.mcap", part_of(recorded_run(kScans), 1));
  const auto live = open_live(input(0.0), {}, control());
  const auto whole = open_log(folder_.path());
  EXPECT_EQ(expect_same_frames(*live, *whole), 40U);
  EXPECT_EQ(name_of(input()), folder_.path().filename().string());
  LiveInput with_slash = input();
  with_slash.file += '/';
  EXPECT_EQ(name_of(with_slash), folder_.path().filename().string());
}

TEST_F(GrowingFolderTest, files_that_were_read_may_be_deleted) {
  const auto write = [&](std::size_t number) {
    const std::string name = "run_" + std::to_string(number) + ".db3";
    write_db3(folder_.path() / name, part_of(recorded_run(kScans), number));
  };
  write(0);
  write(1);
  const auto live = open_live(input(0.0), {}, control());
  ASSERT_TRUE(live->next());
  std::filesystem::remove(folder_.path() / "run_0.db3");
  write(2);
  EXPECT_EQ(all_frames(*live).size(), static_cast<std::size_t>(kScans) - 1);
}

TEST_F(GrowingFolderTest, ends_within_a_compressed_file_when_the_user_stops) {
  write_db3(folder_.path() / "run_0.db3", recorded_run(kScans));
  write_file(folder_.path() / "run_0.db3.zstd", zstd_frame(read_file(folder_.path() / "run_0.db3")));
  std::filesystem::remove(folder_.path() / "run_0.db3");
  bool stops = false;
  LiveControl stoppable = control();
  stoppable.should_stop = [&] { return stops; };
  const auto live = open_live(input(), {}, stoppable);
  ASSERT_TRUE(live->next());
  stops = true;
  EXPECT_LT(all_frames(*live).size(), static_cast<std::size_t>(kScans) / 2);
}

TEST_F(GrowingFolderTest, a_single_database_ends_when_the_recorder_closes_its_bag) {
  write_db3(folder_.path() / "run_0.db3", recorded_run(kScans));
  write_file(folder_.path() / "metadata.yaml", metadata({"run_0.db3"}));
  LiveInput file = input();
  file.file = (folder_.path() / "run_0.db3").string();
  const auto live = open_live(file, {}, control());
  EXPECT_EQ(all_frames(*live).size(), static_cast<std::size_t>(kScans));
}

TEST_F(GrowingFolderTest, an_empty_bag_is_an_error) {
  write_file(folder_.path() / "run_0.mcap", "");
  write_db3(folder_.path() / "run_1.db3", {});
  write_file(folder_.path() / "metadata.yaml", metadata({"run_0.mcap", "run_1.db3"}));
  const auto live = open_live(input(0.0), {}, control());
  EXPECT_THAT(sentence_of([&] { live->next(); }), HasSubstr("has no laser scans"));
}

TEST_F(GrowingFolderTest, knows_whether_a_bag_is_closed) {
  EXPECT_FALSE(is_closed_bag(folder_.path()));
  write_file(folder_.path() / "metadata.yaml", "rosbag2_bagfile_information:\n  version: 5\n");
  EXPECT_FALSE(is_closed_bag(folder_.path()));
  write_file(folder_.path() / "metadata.yaml", metadata({"run_0.db3"}));
  EXPECT_TRUE(is_closed_bag(folder_.path()));
  EXPECT_TRUE(is_closed_bag(folder_.path(), "run_0.db3"));
  EXPECT_FALSE(is_closed_bag(folder_.path(), "other.db3"));
}

}  // namespace
}  // namespace psi_slam
