// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rawlog/rawlog_archive.h"

#include <gmock/gmock.h>
#include <mrpt/obs/CObservationComment.h>
#include <mrpt/poses/CPose2D.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <fstream>
#include <set>
#include <sstream>
#include <thread>

#include "base/forked_child.h"

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
  const auto pose = mrpt::poses::CPose2D::Create();
  write_rawlog(path_, {comment, sensory_frame({comment, range_scan(2)}), pose, range_scan(3), comment},
               false);
  RawlogArchive archive(path_);
  const auto frame = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(archive.next());
  ASSERT_TRUE(frame);
  EXPECT_EQ(frame->size(), 1U);
  EXPECT_EQ(archive.place(), path_.string() + ": object 2");
  EXPECT_TRUE(std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(archive.next()));
  EXPECT_EQ(archive.place(), path_.string() + ": object 4");
  EXPECT_GT(archive.progress(), 0.5);
  EXPECT_EQ(archive.next(), nullptr);
  EXPECT_EQ(archive.place(), path_.string() + ": object 5");
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
  for (int i = 0; i < 2; ++i) EXPECT_EQ(sentence_of([&] { archive.next(); }), damaged_object(3));
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
  EXPECT_EQ(sentence_of([&] {
              while (archive.next()) {
              }
            }),
            "the process that reads " + path_.string() +
                " was killed (signal 9). Make sure that there is enough memory");
}

/// The system sends this signal at the limit of processor time.
TEST_F(RawlogChild, has_a_limit_of_time) {
  RawlogArchive archive(path_);
  ASSERT_TRUE(archive.next());
  std::ifstream limits("/proc/" + std::to_string(child()) + "/limits");
  std::string line;
  while (std::getline(limits, line) && line.rfind("Max cpu time", 0) != 0) continue;
  std::istringstream words(line.substr(12));
  int limit_s = 0;
  EXPECT_TRUE(words >> limit_s) << line;
  EXPECT_GE(limit_s, 10);
  EXPECT_LE(limit_s, 20);
  ASSERT_EQ(::kill(child(), SIGXCPU), 0);
  EXPECT_THAT(
      sentence_of([&] {
        while (archive.next()) {
        }
      }),
      testing::EndsWith(" takes MRPT more than 10 s, so it is probably damaged. Fetch the log again"));
}

TEST_F(RawlogChild, does_not_get_the_signals_of_the_terminal) {
  RawlogArchive archive(path_);
  ASSERT_TRUE(archive.next());
  EXPECT_NE(::getpgid(child()), ::getpgid(0));
}

TEST_F(RawlogChild, ends_with_its_archive) {
  { RawlogArchive(path_).next(); }
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  EXPECT_EQ(errno, ECHILD);
}

TEST_F(RawlogChild, ends_after_its_parent_was_killed) {
  Pipe pipe;
  const pid_t parent = ::fork();
  if (parent == 0) {
    try {
      RawlogArchive archive(path_);
      archive.next();
      const pid_t pid = child();
      if (write_all(pipe.writing(), {reinterpret_cast<const char*>(&pid), sizeof pid}))
        for (;;) ::pause();
    } catch (...) {
    }
    ::_exit(1);
  }
  ASSERT_GT(parent, 0);
  pipe.close_writing();
  RunningChild running(parent);
  pid_t grandchild = 0;
  ASSERT_TRUE(pipe.read_exactly(&grandchild, sizeof grandchild));
  running.kill();
  running.wait();
  const auto lives = [&] {
    std::string text;
    std::ifstream status("/proc/" + std::to_string(grandchild) + "/stat");
    return std::getline(status, text) && text.find(") Z ") == std::string::npos;
  };
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::minutes(1);
  while (lives() && std::chrono::steady_clock::now() < deadline) ::usleep(1000);
  EXPECT_FALSE(lives());
}

/// Otherwise the child of the other archive would wait for a reader as long as this one runs.
TEST_F(RawlogChild, keeps_no_descriptor_of_its_parent) {
  RawlogArchive first(path_);
  ASSERT_TRUE(first.next());
  const pid_t other = child();
  RawlogArchive second(path_);
  ASSERT_TRUE(second.next());
  std::ifstream children("/proc/thread-self/children");
  pid_t pid = 0;
  while (children >> pid && pid == other) continue;
  ASSERT_NE(pid, other);
  std::multiset<std::string> others;
  for (const auto& entry : std::filesystem::directory_iterator("/proc/" + std::to_string(pid) + "/fd")) {
    const std::filesystem::path target = std::filesystem::read_symlink(entry);
    if (target != "/dev/null" && target != std::filesystem::canonical(path_)) others.insert(target);
  }
  EXPECT_EQ(others.size(), 1U) << "besides its log, it has only its pipe";
}

TEST_F(RawlogChild, is_started_by_several_threads) {
  write_rawlog(path_, RawlogObjects(3, range_scan(1)), false);
  std::atomic<int> objects = 0;
  std::vector<std::thread> threads;
  for (int thread = 0; thread < 4; ++thread)
    threads.emplace_back([&] {
      for (int run = 0; run < 10; ++run)
        for (RawlogArchive archive(path_); archive.next();) ++objects;
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(objects, 4 * 10 * 3);
}

TEST_F(RawlogArchiveTest, reads_an_object_larger_than_a_pipe) {
  std::vector<float> ranges_m(100'000);
  for (std::size_t i = 0; i < ranges_m.size(); ++i) ranges_m[i] = 0.001F * static_cast<float>(i);
  write_rawlog(path_, {range_scan(1, "laser", ranges_m), range_scan(2)}, true);
  RawlogArchive archive(path_);
  const auto scan = std::dynamic_pointer_cast<mrpt::obs::CObservation2DRangeScan>(archive.next());
  ASSERT_TRUE(scan);
  ASSERT_EQ(scan->getScanSize(), ranges_m.size());
  for (std::size_t i = 0; i < ranges_m.size(); ++i) ASSERT_EQ(scan->getScanRange(i), ranges_m[i]);
  EXPECT_TRUE(archive.next());
}

TEST_F(RawlogArchiveTest, reports_movements_with_too_many_particles) {
  mrpt::obs::CActionRobotMovement2D action;
  mrpt::obs::CActionRobotMovement2D::TMotionModelOptions options;
  options.modelSelection = mrpt::obs::CActionRobotMovement2D::mmThrun;
  options.thrunModel.nParticlesCount = 100'001;
  action.computeFromOdometry({1, 2, 3}, options);
  write_rawlog(path_, {range_scan(1), mrpt::obs::CActionCollection::Create(action)}, false);
  EXPECT_EQ(
      sentence_of([&] { read_all(); }),
      path_.string() + ": object 2 is damaged: its contents contradict each other. Fetch the log again");
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
