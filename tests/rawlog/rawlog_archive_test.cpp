// SPDX-License-Identifier: BSD-3-Clause
#include "rawlog/rawlog_archive.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <sys/wait.h>

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <fstream>

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

  std::string damaged_object(int number) const {
    return path_.string() + ": object " + std::to_string(number) +
           " needs more than 512 MiB of memory or crashes MRPT, so it is probably damaged. Fetch the log "
           "again";
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

TEST_F(RawlogArchiveTest, leaves_out_observations_that_psi_slam_does_not_use) {
  const auto comment = mrpt::obs::CObservationComment::Create();
  write_rawlog(path_, {comment, sensory_frame({comment, range_scan(2)}), range_scan(3), comment}, false);
  RawlogArchive archive(path_);
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(archive.next());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->size(), 1U);
  EXPECT_EQ(archive.place(), path_.string() + ": object 2");
  EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(archive.next()));
  EXPECT_EQ(archive.next(), nullptr);
  EXPECT_EQ(archive.place(), path_.string() + ": object 4");
}

TEST_F(RawlogArchiveTest, reports_a_file_that_cannot_be_opened) {
  EXPECT_THAT(sentence_of([&] { read_all(); }), testing::StartsWith(path_.string() + " does not exist"));
}

/// Version 0 of a movement has a probability density, of which MRPT asks the mean, also if it is another
/// object.
TEST_F(RawlogArchiveTest, reports_an_object_that_crashes_mrpt) {
  write_rawlog(path_, {range_scan(1)}, false);
  const std::string scan = read_file(path_);
  const std::string movement = std::string("\x96") + "CActionRobotMovement2D" + '\0';
  write_file(path_, scan + scan + movement + scan + std::string(100, '\0'));
  RawlogArchive archive(path_);
  EXPECT_TRUE(archive.next());
  EXPECT_TRUE(archive.next());
  EXPECT_EQ(sentence_of([&] { archive.next(); }), damaged_object(3));
}

/// A rawlog that does not fit into a pipe, so that its child process waits for the parent.
class RawlogChild : public RawlogArchiveTest {
 protected:
  RawlogChild() { write_rawlog(path_, RawlogObjects(kObjects, range_scan(1)), false); }

  /// Returns the only child process of this one.
  static pid_t child() {
    std::ifstream children("/proc/thread-self/children");
    pid_t pid = 0;
    EXPECT_TRUE(children >> pid);
    EXPECT_FALSE(children >> pid) << "there are more children";
    return pid;
  }

  static constexpr std::size_t kObjects = 2000;
};

TEST_F(RawlogChild, reports_that_it_was_killed) {
  RawlogArchive archive(path_);
  ASSERT_TRUE(archive.next());
  ASSERT_EQ(::kill(child(), SIGKILL), 0);
  try {
    while (archive.next()) {
    }
    FAIL() << "the rest of the file was read";
  } catch (const SystemFailure& failure) {
    EXPECT_EQ(failure.what(), "the process that reads " + path_.string() + " was killed");
  }
}

TEST_F(RawlogChild, goes_on_after_ctrl_c) {
  RawlogArchive archive(path_);
  ASSERT_TRUE(archive.next());
  ASSERT_EQ(::kill(child(), SIGINT), 0);
  std::size_t objects = 1;
  while (archive.next()) ++objects;
  EXPECT_EQ(objects, kObjects);
}

TEST_F(RawlogChild, ends_with_its_archive) {
  { RawlogArchive(path_).next(); }
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

/// Otherwise the first child would wait for a reader of its pipe as long as the second one runs.
TEST_F(RawlogChild, keeps_no_pipe_of_another_child) {
  auto first = std::make_unique<RawlogArchive>(path_);
  ASSERT_TRUE(first->next());
  RawlogArchive second(path_);
  ASSERT_TRUE(second.next());
  first.reset();
  std::size_t objects = 1;
  while (second.next()) ++objects;
  EXPECT_EQ(objects, kObjects);
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
  EXPECT_EQ(sentence_of([&] { read_all(); }), damaged_object(1));
}

}  // namespace
}  // namespace psi_slam
