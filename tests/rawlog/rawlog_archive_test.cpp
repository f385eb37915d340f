// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/rawlog_archive.h"

#include <gmock/gmock.h>

#include <cstdint>

#include "log_files.h"
#include "rawlog_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

class RawlogArchiveTest : public testing::Test {
 protected:
  std::size_t read_all() {
    RawlogArchive archive(path_);
    std::size_t objects = 0;
    while (archive.next()) ++objects;
    EXPECT_EQ(archive.place(), path_.string() + ": object " + std::to_string(objects));
    EXPECT_EQ(archive.progress(), 1.0);
    return objects;
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "log.rawlog";
  RawlogObjects objects_{range_scan(1), movement({1, 2, 3}), sensory_frame({range_scan(2)}),
                         odometry(3, {0, 0, 0})};
};

TEST_F(RawlogArchiveTest, reads_every_object_plain_and_gzipped) {
  write_rawlog(path_, objects_, false);
  EXPECT_EQ(read_all(), 4U);
  write_rawlog(path_, objects_, true);
  EXPECT_EQ(read_all(), 4U);
}

TEST_F(RawlogArchiveTest, reports_a_plain_file_truncated_anywhere) {
  write_rawlog(path_, objects_, false);
  const std::string whole = read_file(path_);
  const std::size_t step = 29;  // not every byte, because MRPT's exceptions are slow
  for (std::size_t size = 1; size < whole.size(); size += step) {
    write_file(path_, whole.substr(0, size));
    RawlogArchive archive(path_);
    std::size_t objects = 0;
    const std::string sentence = sentence_of([&] {
      while (archive.next()) ++objects;
    });
    EXPECT_LT(objects, 4U);
    EXPECT_EQ(sentence, path_.string() + ": object " + std::to_string(objects + 1) +
                            ": the file ends within this object. Fetch the log again")
        << "cut after " << size << " bytes";
  }
}

TEST_F(RawlogArchiveTest, reports_a_truncated_gzip_file) {
  write_rawlog(path_, objects_, true);
  std::filesystem::resize_file(path_, std::filesystem::file_size(path_) - 20);
  EXPECT_EQ(sentence_of([&] { read_all(); }),
            path_.string() + " is cut off: its compressed data are incomplete. Fetch it again");
}

TEST_F(RawlogArchiveTest, reports_an_unknown_or_damaged_object) {
  write_rawlog(path_, {range_scan(1)}, false);
  write_file(path_, read_file(path_) + "\x8A" + "CObservati" + std::string(40, '\0'));
  EXPECT_EQ(sentence_of([&] { read_all(); }), path_.string() +
                                                  ": object 2 is damaged or has a class that this version of "
                                                  "MRPT does not know, expected an action, a "
                                                  "sensory frame or an observation");
}

/// Without a limit, MRPT would take 4 GiB and then find the end of the file.
TEST_F(RawlogArchiveTest, refuses_an_object_that_states_a_billion_elements) {
  const std::vector<float> ranges_m{1, 2, 3, 4, 5};
  write_rawlog(path_, {range_scan(1, "laser", ranges_m)}, false);
  std::string damaged = read_file(path_);
  const auto little_endian = [](const auto& value) {
    return std::string(reinterpret_cast<const char*>(&value), sizeof value);
  };
  const std::string count = little_endian(std::uint32_t{5});
  const std::size_t place = damaged.find(count + little_endian(ranges_m[0]));
  ASSERT_NE(place, std::string::npos);
  write_file(path_, damaged.replace(place, count.size(), little_endian(std::uint32_t{1} << 30)));
  EXPECT_EQ(
      sentence_of([&] { read_all(); }),
      path_.string() +
          ": object 1 needs more than 256 MiB of memory, so it is probably damaged. Fetch the log again");
}

}  // namespace
}  // namespace psi_slam
