// SPDX-License-Identifier: BSD-3-Clause
// Reading a bag that is truncated or damaged anywhere ends with an error message or skips the damage, never
// with a crash or gigabytes of memory. It yields the frames before the damage.
#include <gmock/gmock.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <random>
#include <string>

#include "bag_files.h"
#include "decompression_bombs.h"
#include "log_files.h"
#include "ros1_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;

struct BagKind {
  std::string name;
  std::function<void(const Path&, const Recording&)> write;
  friend void PrintTo(const BagKind& kind, std::ostream* out) { *out << kind.name; }
};

struct Reading {
  std::size_t frames = 0;
  std::string sentence;  ///< error at the end; empty if there was none
  std::string skipped;   ///< error of the first part that was skipped; empty if there was none
};

Reading read_to_the_end(const Path& path) {
  Reading reading;
  std::unique_ptr<FrameSource> log;
  try {
    log = open_log(path);
    while (log->next()) ++reading.frames;
    EXPECT_FALSE(log->next()) << "there is no frame after the end";
  } catch (const UserError& error) {
    reading.sentence = error.what();
  }
  if (log) reading.skipped = log->skipped_lines().first;
  return reading;
}

class DamagedBag : public testing::TestWithParam<BagKind> {
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
    testing::Values(BagKind{"ros1", [](const Path& p, const Recording& r) { write_ros1_bag(p, r); }},
                    BagKind{"ros1_bz2",
                            [](const Path& p, const Recording& r) {
                              write_ros1_bag(p, r, {"bz2", 4, true});
                            }},
                    BagKind{"ros1_lz4",
                            [](const Path& p, const Recording& r) {
                              write_ros1_bag(p, r, {"lz4", 4, true});
                            }},
                    BagKind{"db3", [](const Path& p, const Recording& r) { write_db3(p, r); }},
                    BagKind{"mcap",
                            [](const Path& p, const Recording& r) {
                              write_mcap(p, r, {"", 0, true, true});
                            }},
                    BagKind{"mcap_lz4",
                            [](const Path& p, const Recording& r) {
                              write_mcap(p, r, {"lz4", 4, true, true});
                            }},
                    BagKind{"mcap_zstd",
                            [](const Path& p, const Recording& r) {
                              write_mcap(p, r, {"zstd", 4, true, true});
                            }},
                    BagKind{"mcap_of_compressed_messages",
                            [](const Path& p, const Recording& r) {
                              write_mcap(p, r, {"", 0, true, true, true});
                            }},
                    BagKind{"mcap_in_zstd",
                            [](const Path& p, const Recording& r) {
                              write_mcap(p, r, {"", 4, true, true});
                              write_file(p, zstd_frame(read_file(p), 500));
                            }},
                    BagKind{"db3_in_zstd",
                            [](const Path& p, const Recording& r) {
                              write_db3(p, r);
                              write_file(p, zstd_frame(read_file(p), 500));
                            }}),
    [](const auto& tested) { return tested.param.name; });

TEST(CutOffBag, within_its_only_chunk_is_not_taken_for_a_bag_without_scans) {
  const TemporaryFolder folder;
  const Path path = folder.path() / "bag";
  write_ros1_bag(path, recorded_run(8), {"none", 1000, true});
  const std::uintmax_t bag_header_bytes = 4117;
  ASSERT_GT(std::filesystem::file_size(path), bag_header_bytes + 1000);
  std::filesystem::resize_file(path, bag_header_bytes + 1000);
  EXPECT_THAT(read_to_the_end(path).sentence, testing::HasSubstr("the file is cut off"));
}

// ---- Stated sizes ----

constexpr std::uint64_t kGigabytes = 3'000'000'000;

std::string mcap_record(char kind, std::uint64_t stated, const std::string& bytes) {
  return kind + ros1_packed(stated) + bytes;
}

std::string mcap_chunk(std::uint64_t stated, const std::string& compression, const std::string& bytes) {
  const std::string content = std::string(16, '\0') + ros1_packed(stated) + ros1_packed(std::uint32_t{0}) +
                              ros1_text(compression) + ros1_packed(std::uint64_t{bytes.size()}) + bytes;
  return mcap_record('\x06', content.size(), content);
}

class StatedSize : public testing::Test {
 protected:
  /// Reads an MCAP file of eight scans, with `record` and then `zeros` bytes 0 after them.
  Reading read_mcap_with(const std::string& record, std::uint64_t zeros = 0) {
    McapBytesWriter writer({"", 0, false, true});
    for (const Recorded& message : recorded_run(8)) writer.add(message);
    const std::string whole = writer.finish();
    const std::size_t end_bytes = 13 + 29 + 8;  // of the records DataEnd and Footer and the last magic bytes
    write_file(path_, whole.substr(0, whole.size() - end_bytes) + record);
    std::filesystem::resize_file(path_, std::filesystem::file_size(path_) + zeros);
    return read_to_the_end(path_);
  }

  static void expect_gigabytes_refused(const Reading& reading, const std::string& sentence) {
    EXPECT_EQ(reading.frames, 8U);
    EXPECT_THAT(sentence, testing::HasSubstr("the bag is damaged: it states a size of 3000000000 "
                                             "bytes, expected at most 134217728. Fetch the bag again"));
  }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "bag";
};

TEST_F(StatedSize, of_gigabytes_for_an_mcap_record_or_chunk_needs_no_memory) {
  expect_little_memory([&] {
    const Reading chunk = read_mcap_with(mcap_chunk(kGigabytes, "zstd", frame_of_zeros(kGigabytes)));
    expect_gigabytes_refused(chunk, chunk.skipped);
    const Reading record = read_mcap_with(mcap_record('\x05', kGigabytes, ""), kGigabytes);
    expect_gigabytes_refused(record, record.sentence);
  });
}

TEST_F(StatedSize, of_gigabytes_for_an_attachment_is_skipped) {
  expect_little_memory([&] {
    const Reading reading = read_mcap_with(mcap_record('\x09', 1'500'000'000, ""), 1'400'000'000);
    EXPECT_EQ(reading.frames, 8U);
    EXPECT_THAT(reading.sentence,
                testing::HasSubstr("the file is cut off, expected 1500000000 more bytes, found 1400000000"));
  });
}

TEST_F(StatedSize, of_a_message_that_decompresses_to_gigabytes_is_bounded) {
  expect_little_memory([&] {
    const std::string head = ros1_packed(std::uint16_t{2}) + std::string(20, '\0');  // channel of /scan
    const std::string message = head + frame_of_zeros(kGigabytes);
    const Reading reading = read_mcap_with(mcap_record('\x05', message.size(), message));
    EXPECT_EQ(reading.frames, 8U);
    EXPECT_THAT(reading.skipped,
                testing::HasSubstr("its data decompress to more than the expected 134217728 bytes"));
  });
}

TEST_F(StatedSize, of_gigabytes_for_a_ros1_chunk_needs_no_memory) {
  for (const char* compression : {"none", "lz4", "bz2"}) {
    write_ros1_bag(path_, recorded_run(8), {compression, 30, true});
    std::string bytes = read_file(path_);
    bytes.replace(bytes.rfind("size=") + 5, 4, ros1_packed(static_cast<std::uint32_t>(kGigabytes)));
    write_file(path_, bytes);
    expect_little_memory([&] {
      EXPECT_THAT(read_to_the_end(path_).sentence,
                  testing::HasSubstr("it states a size of 3000000000 bytes"));
    });
  }
}

TEST_F(StatedSize, of_an_uncompressed_chunk_must_be_its_size) {
  EXPECT_THAT(read_mcap_with(mcap_chunk(5, "", "1234")).skipped,
              testing::HasSubstr("the bag is damaged: a chunk has 4 bytes, not the 5 that it states"));
  write_ros1_bag(path_, recorded_run(8), {"none", 1000, true});
  std::string bytes = read_file(path_);
  bytes[bytes.find("size=") + 5] ^= 1;
  write_file(path_, bytes);
  EXPECT_THAT(read_to_the_end(path_).sentence, testing::HasSubstr("bytes, not the"));
}

}  // namespace
}  // namespace psi_slam
