// SPDX-License-Identifier: BSD-3-Clause
// Reading a bag that is truncated or damaged anywhere ends with an error message, never with a crash or
// gigabytes of memory. It yields the frames before the damage.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>
#include <string>

#include "bag_files.h"
#include "log_files.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;

struct Kind {
  std::string name;
  std::function<void(const Path&, const Recording&)> write;
  friend void PrintTo(const Kind& kind, std::ostream* out) { *out << kind.name; }
};

struct Reading {
  std::size_t frames = 0;
  std::string sentence;  ///< error at the end; empty if there was none
};

Reading read_to_the_end(const Path& path) {
  Reading reading;
  try {
    const auto log = open_log(path);
    while (log->next()) ++reading.frames;
    EXPECT_FALSE(log->next()) << "there is no frame after the end";
  } catch (const UserError& error) {
    reading.sentence = error.what();
  }
  return reading;
}

class DamagedBag : public testing::TestWithParam<Kind> {
 protected:
  void SetUp() override {
    GetParam().write(path_, recorded_run(8));
    whole_ = read_file(path_);
  }

  /// Overwrites the bag with `bytes`, which must have the size of the undamaged bag, and reads it. That is
  /// faster than creating a file.
  Reading read(const std::string& bytes) const {
    std::fstream file(path_, std::ios::binary | std::ios::in | std::ios::out);
    file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    file.close();
    return read_to_the_end(path_);
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "bag";
  std::string whole_;
};

TEST_P(DamagedBag, truncated_anywhere_yields_the_frames_before) {
  const Reading all = read(whole_);
  EXPECT_EQ(all.frames, 8U);
  EXPECT_EQ(all.sentence, "");
  std::size_t least = 8;
  // Tests every length, and thus cuts after every record; for SQLite tests only some lengths.
  const std::size_t step = GetParam().name == "db3" ? 97 : 1;
  for (std::size_t size = whole_.size() - 1; size > step; size -= step) {
    std::filesystem::resize_file(path_, size);
    const Reading reading = read_to_the_end(path_);
    ASSERT_TRUE(!reading.sentence.empty() || reading.frames == 8) << size;
    ASSERT_LE(reading.frames, least + 3)
        << "a shorter bag has fewer frames, except scans that wait for odometry";
    if (size + 400 > whole_.size()) {
      ASSERT_GE(reading.frames, 4U) << "a bag that lacks little has at least half of the frames";
    }
    least = std::min(least, reading.frames);
  }
  EXPECT_EQ(least, 0U);
}

TEST_P(DamagedBag, with_flipped_bits_yields_a_message_or_frames) {
  std::mt19937 random(1);
  const std::size_t first = GetParam().name == "db3" ? 0 : 13;
  for (int i = 0; i < 600; ++i) {
    std::string bytes = whole_;
    for (int flips = 1 + i % 3; flips > 0; --flips)
      bytes[first + random() % (bytes.size() - first)] ^= static_cast<char>(1 << random() % 8);
    read(bytes);
  }
}

TEST_P(DamagedBag, lengths_of_gigabytes_allocate_no_memory) {
  for (std::size_t at = 13; at + 4 <= std::min<std::size_t>(whole_.size(), 6000); at += 7) {
    std::string bytes = whole_;
    bytes.replace(at, 4, "\xF0\xFF\xFF\x7F");
    read(bytes);
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, DamagedBag,
    testing::Values(Kind{"ros1", [](const Path& p, const Recording& r) { write_ros1_bag(p, r); }},
                    Kind{"ros1_bz2",
                         [](const Path& p, const Recording& r) {
                           write_ros1_bag(p, r, {"bz2", 4, true});
                         }},
                    Kind{"ros1_lz4",
                         [](const Path& p, const Recording& r) {
                           write_ros1_bag(p, r, {"lz4", 4, true});
                         }},
                    Kind{"db3", [](const Path& p, const Recording& r) { write_db3(p, r); }},
                    Kind{"mcap",
                         [](const Path& p, const Recording& r) {
                           write_mcap(p, r, {"", 0, true, true});
                         }},
                    Kind{"mcap_lz4",
                         [](const Path& p, const Recording& r) {
                           write_mcap(p, r, {"lz4", 4, true, true});
                         }},
                    Kind{"mcap_zstd",
                         [](const Path& p, const Recording& r) {
                           write_mcap(p, r, {"zstd", 4, true, true});
                         }}),
    [](const auto& tested) { return tested.param.name; });

}  // namespace
}  // namespace psi_slam
