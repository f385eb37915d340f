// SPDX-License-Identifier: BSD-3-Clause
// A bag whose damage is confined to a chunk or to a compressed message yields all other frames, in a file as
// in a stream, and counts the damage.
#include <gmock/gmock.h>

#include <functional>
#include <string>
#include <vector>

#include "bag_files.h"
#include "base/compression/compressed_file.h"
#include "log_files.h"
#include "logs/frames/look_over.h"
#include "logs/rosbag/rosbag_stream.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;
using testing::HasSubstr;

struct DamagedKind {
  std::string name;
  std::function<void(const Path&, const Recording&)> write;
  std::string begin;      // first bytes of each part that may be damaged
  std::size_t most_lost;  // scans
  friend void PrintTo(const DamagedKind& kind, std::ostream* out) { *out << kind.name; }
};

constexpr std::size_t kScans = 60;

class DamagedPartOfABag : public testing::TestWithParam<DamagedKind> {
 protected:
  /// Writes a bag and damages its part `number`.
  void write(std::size_t number) const {
    GetParam().write(path_, recorded_run(kScans));
    std::string bytes = read_file(path_);
    std::size_t at = 0;
    for (std::size_t part = 0; part <= number; ++part) {
      at = bytes.find(GetParam().begin, at + 1);
      ASSERT_NE(at, std::string::npos);
    }
    write_file(path_, bytes.replace(at + GetParam().begin.size(), 4, "\xFF\xFF\xFF\xFF"));
  }

  std::unique_ptr<LogReader> followed() const {
    if (GetParam().name.find("db3") == std::string::npos)
      return open_rosbag_stream(std::make_unique<CompressedFile>(path_), {}, kUsualLookOver_s);
    BagRecorder recorder;
    recorder.should_stop = [] { return false; };
    recorder.wait = [](double) { return false; };
    return open_followed_bag(
        std::make_unique<BagRecording>(BagRecording{path_, follow_sqlite_bag(path_, recorder)}), {},
        kUsualLookOver_s);
  }

  void expect_most_frames(LogReader& log) const {
    const std::vector<Frame> frames = all_frames(log);
    EXPECT_GE(frames.size() + GetParam().most_lost, kScans);
    EXPECT_LT(frames.size(), kScans + 1);
    EXPECT_TRUE(frames.back().has_odometry);
    EXPECT_EQ(log.skipped_lines().count, 1U);
    EXPECT_THAT(log.skipped_lines().first,
                HasSubstr(GetParam().most_lost > 1 ? "a chunk of messages is lost" : "damaged"));
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run";
};

TEST_P(DamagedPartOfABag, is_skipped_and_counted) {
  for (const std::size_t number : {0U, 4U, 10U}) {
    SCOPED_TRACE(number);
    write(number);
    expect_most_frames(*open_log_reader(path_, {}));
  }
}

TEST_P(DamagedPartOfABag, is_skipped_and_counted_in_a_stream) {
  for (const std::size_t number : {4U, 10U}) {
    SCOPED_TRACE(number);
    write(number);
    expect_most_frames(*followed());
  }
}

TEST_P(DamagedPartOfABag, is_named_if_nothing_is_left) {
  write(0);
  std::string bytes = read_file(path_);
  for (std::size_t at = 0; (at = bytes.find(GetParam().begin, at + 1)) != std::string::npos;)
    bytes.replace(at + GetParam().begin.size(), 4, "\xFF\xFF\xFF\xFF");
  write_file(path_, bytes);
  EXPECT_THAT(sentence_of([&] { all_frames(*open_log_reader(path_, {})); }), HasSubstr("damaged"));
}

std::function<void(const Path&, const Recording&)> ros1(const std::string& compression) {
  return [=](const Path& path, const Recording& recording) {
    write_ros1_bag(path, recording, {compression, 7, true});
  };
}

std::function<void(const Path&, const Recording&)> mcap(const McapLayout& layout) {
  return [=](const Path& path, const Recording& recording) { write_mcap(path, recording, layout); };
}

const std::string kZstd = "\x28\xB5\x2F\xFD";
const std::string kLz4 = "\x04\x22\x4D\x18";

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedPartOfABag,
    testing::Values(DamagedKind{"ros1_lz4", ros1("lz4"), kLz4, 3},
                    DamagedKind{"ros1_bz2", ros1("bz2"), "BZh9", 3},
                    DamagedKind{"mcap_lz4", mcap({"lz4"}), kLz4, 3},
                    DamagedKind{"mcap_zstd", mcap({"zstd"}), kZstd, 3},
                    DamagedKind{"mcap_of_messages", mcap({"", 0, true, true, true}), kZstd, 1},
                    DamagedKind{"mcap_of_messages_in_chunks", mcap({"lz4", 1, true, true, true}), kLz4, 1},
                    DamagedKind{"db3_of_messages",
                                [](const Path& path, const Recording& recording) {
                                  write_db3(path, recording, true, true);
                                },
                                kZstd, 1}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace psi_slam
