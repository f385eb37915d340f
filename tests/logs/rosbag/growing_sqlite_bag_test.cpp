// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <sqlite3.h>

#include <chrono>
#include <ostream>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "bag_files.h"
#include "logs/rosbag/bag_file.h"
#include "other_process.h"
#include "soon.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using Path = std::filesystem::path;
using Pragmas = std::vector<std::string>;
using namespace std::chrono_literals;
using testing::ElementsAre;
using testing::HasSubstr;

/// Messages as text, each with its topic, time and bytes.
std::vector<std::string> messages_of(BagFile& bag) {
  std::vector<std::string> messages;
  for (BagMessage message; bag.next(message);)
    messages.push_back(message.topic->name + ' ' + message.topic->type + ' ' +
                       std::to_string(message.recorded_us) + ' ' + std::string(message.bytes));
  return messages;
}

/// Odometry, with a scan after every eighth message, and later a second laser with large messages.
Recording long_recording(int messages) {
  Recording recording{static_mount()};
  for (int i = 0; i < messages; ++i) {
    RecordedScan scan;
    scan.time_us = 1'600'000'000'000'000 + TimeUs{i} * 1'000;
    if (i > messages / 2 && i % 50 == 0) {
      scan.topic = "/second";
      scan.ranges_m.assign(30'000, 2.0F);
    }
    if (i % 8 == 0 || scan.topic != "/scan") {
      recording.emplace_back(scan);
    } else {
      recording.emplace_back(
          RecordedPose{"/odom", scan.time_us, "odom", "base_link", {0.01 * i, 0, 0, 0, 0, 0}});
    }
  }
  return recording;
}

/// A recorder that works in the background until `is_closed`.
BagRecorder recorder_until(std::function<bool()> is_closed) {
  BagRecorder recorder;
  recorder.should_stop = [] { return false; };
  recorder.wait = [](double waited_s) {
    std::this_thread::sleep_for(1ms);
    return waited_s < 60;
  };
  recorder.is_closed = std::move(is_closed);
  return recorder;
}

/// Settings of the database of the recorder. The first two are those of rosbag2.
struct Setting {
  std::string name;
  Pragmas pragmas;
  friend void PrintTo(const Setting& setting, std::ostream* out) { *out << setting.name; }
};

class GrowingSqliteBag : public testing::TestWithParam<Setting> {
 protected:
  bool is_closed() const { return std::filesystem::exists(closed_); }

  TemporaryFolder folder_;
  Path path_ = folder_.path() / "run_0.db3";
  Path closed_ = folder_.path() / "closed";
};

/// A recorder that is killed within a change. With the journal in memory, as rosbag2 has it by default,
/// nobody can undo the half of a change.
class KilledRecorder : public GrowingSqliteBag {
 protected:
  static void wait_for(const Path& file) {
    if (!soon([&] { return std::filesystem::exists(file); })) throw std::runtime_error("waited too long");
  }

  Path read_ = folder_.path() / "read";  // exists when the first transaction was read
};

TEST_P(GrowingSqliteBag, has_all_messages_and_never_blocks_the_recorder) {
  const Recording recording = long_recording(4000);
  OtherProcess recorder([&] {
    {
      Db3Writer writer(path_, GetParam().pragmas);
      std::this_thread::sleep_for(5ms);
      writer.create_tables();
      for (std::size_t i = 0; i < recording.size();) {
        writer.begin();
        for (const std::size_t end = std::min(i + 1 + i % 13, recording.size()); i < end; ++i)
          writer.add(recording[i], cdr(recording[i]));
        writer.commit();
        if (i % 5 == 0) std::this_thread::sleep_for(1ms);
      }
    }
    write_file(closed_, "");
  });
  ASSERT_TRUE(soon([&] { return std::filesystem::exists(path_); }));
  const auto followed = follow_sqlite_bag(path_, recorder_until([&] { return is_closed(); }));
  const std::vector<std::string> messages = messages_of(*followed);
  EXPECT_TRUE(recorder.succeeds()) << "a lock of the reader ended the recording";
  EXPECT_EQ(messages.size(), recording.size());
  EXPECT_TRUE(messages == messages_of(*open_sqlite_bag(path_)));
  EXPECT_FALSE(std::filesystem::exists(path_.string() + "-wal")) << "the reader kept the log from its end";
  EXPECT_THAT(followed->place(), HasSubstr("run_0.db3: message 4001"));
}

TEST_P(KilledRecorder, leaves_what_it_committed) {
  const Recording recording = long_recording(3000);
  const Path begun = folder_.path() / "begun";
  OtherProcess recorder([&] {
    Pragmas pragmas = GetParam().pragmas;
    pragmas.emplace_back("cache_size=5");  // so pages of the second transaction are written before its end
    Db3Writer writer(path_, pragmas);
    writer.create_tables();
    for (std::size_t i = 0; i < recording.size(); ++i) {
      if (i == 0 || i == 100) writer.begin();
      writer.add(recording[i], cdr(recording[i]));
      if (i == 99) writer.commit();
      if (i == 99) wait_for(read_);
    }
    write_file(begun, "");
    std::this_thread::sleep_for(1min);
  });
  ASSERT_TRUE(soon([&] { return std::filesystem::exists(path_); }));
  BagRecorder impatient = recorder_until([] { return false; });
  bool is_killed = false;
  impatient.wait = [&](double waited_s) {
    std::this_thread::sleep_for(1ms);
    if (is_killed || waited_s > 60) return false;
    if (std::filesystem::exists(begun)) {
      recorder.kill();
      is_killed = true;
    }
    return true;
  };
  const auto followed = follow_sqlite_bag(path_, impatient);
  std::size_t messages = 0;
  for (BagMessage message; followed->next(message);)
    if (++messages == 100) write_file(read_, "");
  EXPECT_TRUE(is_killed);
  EXPECT_EQ(messages, 100U);
}

const Setting kMemory{"memory", {"journal_mode=MEMORY", "synchronous=OFF"}};
const Setting kWal{"wal", {"journal_mode=WAL", "synchronous=NORMAL"}};
const Setting kSmallWal{"small_wal", {"journal_mode=WAL", "synchronous=OFF", "wal_autocheckpoint=7"}};
const Setting kDelete{"delete", {"journal_mode=DELETE", "synchronous=OFF"}};
const Setting kTruncate{"truncate", {"journal_mode=TRUNCATE", "synchronous=OFF"}};
const Setting kPersist{"persist", {"journal_mode=PERSIST", "synchronous=OFF"}};
const Setting kSmallCache{"small_cache", {"journal_mode=DELETE", "synchronous=OFF", "cache_size=5"}};

INSTANTIATE_TEST_SUITE_P(Settings, GrowingSqliteBag,
                         testing::Values(kMemory, kWal, kSmallWal, kDelete, kTruncate, kPersist, kSmallCache),
                         testing::PrintToStringParamName());
INSTANTIATE_TEST_SUITE_P(Settings, KilledRecorder,
                         testing::Values(kWal, kSmallWal, kDelete, kTruncate, kPersist),
                         testing::PrintToStringParamName());

/// A bag that its recorder has closed.
class ClosedSqliteBag : public GrowingSqliteBag {
 protected:
  std::unique_ptr<BagFile> follow() const {
    return follow_sqlite_bag(path_, recorder_until([] { return true; }));
  }

  void run_sql(const std::string& text) const {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(path_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, text.c_str(), nullptr, nullptr, nullptr), SQLITE_OK) << text;
    sqlite3_close(database);
  }

  /// Returns the notices of a reader that waits three times.
  std::vector<std::string> notices() const {
    std::vector<std::string> notices;
    BagRecorder recorder = recorder_until([] { return false; });
    recorder.notify = [&](const std::string& notice) { notices.push_back(notice); };
    recorder.notice_after_s = 0;
    int waits = 0;
    recorder.wait = [&](double) { return ++waits < 3; };
    messages_of(*follow_sqlite_bag(path_, recorder));
    return notices;
  }
};

TEST_F(ClosedSqliteBag, ends_without_tables) {
  write_file(path_, "");
  EXPECT_TRUE(messages_of(*follow()).empty());
  const Db3Writer writer(path_, {"user_version=1"});
  EXPECT_TRUE(messages_of(*follow()).empty());
}

TEST_F(ClosedSqliteBag, gives_only_the_topics_that_are_wanted) {
  write_db3(path_, long_recording(3000), true, true);
  const auto bag = follow();
  bag->want({"/second"});
  const std::vector<std::string> messages = messages_of(*bag);
  EXPECT_EQ(messages.size(), 29U);
  for (const std::string& message : messages)
    EXPECT_THAT(message, HasSubstr("/second sensor_msgs/LaserScan"));
}

TEST_F(ClosedSqliteBag, says_that_it_is_damaged) {
  write_db3(path_, long_recording(3000));
  std::string bytes = read_file(path_);
  for (std::size_t at = 5 * 4096; at < bytes.size(); ++at) bytes[at] = '\x55';
  write_file(path_, bytes);
  const auto bag = follow();
  EXPECT_THAT(sentence_of([&] { messages_of(*bag); }),
              HasSubstr("run_0.db3: after message 0: the bag is damaged"));
  write_file(path_, std::string(5000, 'x'));
  EXPECT_THAT(sentence_of([&] { messages_of(*follow()); }),
              HasSubstr("or is not a ROS 2 bag (file is not a database)"));
  EXPECT_THAT(sentence_of([&] {
                follow_sqlite_bag(folder_.path() / "none.db3", recorder_until([] { return true; }));
              }),
              HasSubstr("cannot read"));
}

TEST_F(ClosedSqliteBag, refuses_tables_of_other_programs) {
  run_sql("CREATE TABLE topics(a)");
  EXPECT_TRUE(messages_of(*follow()).empty()) << "the other table may come";
  run_sql("CREATE TABLE messages(b)");
  EXPECT_THAT(sentence_of([&] { messages_of(*follow()); }),
              HasSubstr("or is not a ROS 2 bag (no such column: id)"));
}

TEST_F(ClosedSqliteBag, says_once_why_nothing_is_read) {
  run_sql("CREATE TABLE others(a)");
  EXPECT_THAT(notices(), ElementsAre(HasSubstr("run_0.db3 has no tables of a ROS 2 bag yet")));
  {
    Db3Writer writer(path_, {"locking_mode=EXCLUSIVE"});
    writer.create_tables();
    EXPECT_THAT(notices(), ElementsAre(HasSubstr("run_0.db3 cannot be read, because its recorder locks it")));
  }
  EXPECT_THAT(notices(), ElementsAre()) << "the recorder only pauses";
}

TEST_F(ClosedSqliteBag, waits_for_rows_of_any_topic) {
  using Clock = std::chrono::steady_clock;
  const Recording recording = long_recording(10);
  Db3Writer writer(path_, {});
  writer.create_tables();
  BagRecorder recorder = recorder_until([] { return false; });
  std::size_t waits = 0;
  Clock::time_point written = Clock::now();
  recorder.wait = [&](double waited_s) {
    EXPECT_LE(waited_s, std::chrono::duration<double>(Clock::now() - written).count()) << waits;
    std::this_thread::sleep_for(1ms);
    written = Clock::now();
    writer.add(recording[waits], cdr(recording[waits]));
    return ++waits < recording.size();
  };
  const auto bag = follow_sqlite_bag(path_, recorder);
  bag->want({"/second"});
  EXPECT_TRUE(messages_of(*bag).empty());
  EXPECT_EQ(waits, recording.size());
}

TEST_F(ClosedSqliteBag, ends_when_the_user_stops) {
  write_db3(path_, long_recording(10));
  BagRecorder recorder = recorder_until([] { return false; });
  int waits = 0;
  recorder.wait = [&](double) { return ++waits < 3; };
  const auto bag = follow_sqlite_bag(path_, recorder);
  EXPECT_EQ(messages_of(*bag).size(), 11U);
  EXPECT_EQ(waits, 3);
  recorder.should_stop = [] { return true; };
  EXPECT_TRUE(messages_of(*follow_sqlite_bag(path_, recorder)).empty());
}

}  // namespace
}  // namespace psi_slam
