// SPDX-License-Identifier: BSD-3-Clause
#include "live/growing_log.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <fstream>

#include "reading_thread.h"
#include "soon.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class GrowingLogTest : public testing::Test {
 protected:
  LiveControl control() {
    return {[this] { return stop_.load(); }, [](const std::string&) {}};
  }
  std::string complaint_about(const std::string& bytes) const {
    const auto file = folder_.path() / "log";
    write_file(file, bytes);
    return sentence_of([&] { growing_format(file); });
  }

  TemporaryFolder folder_;
  std::atomic<bool> stop_ = false;
};

TEST_F(GrowingLogTest, lines_come_when_they_are_complete) {
  const auto file = folder_.path() / "my.log";
  write_file(file, "");
  ReadingThread reader(growing_lines(file, control(), std::nullopt), stop_);
  std::ofstream recorder(file, std::ios::app);
  recorder << "one\ntw" << std::flush;
  EXPECT_TRUE(soon([&] { return reader.text() == "one\n"; }));
  recorder << "o\n" << std::flush;
  EXPECT_TRUE(soon([&] { return reader.text() == "one\ntwo\n"; }));
  stop_ = true;
  EXPECT_EQ(reader.rest(), "one\ntwo\n");
}

TEST_F(GrowingLogTest, bytes_come_at_once) {
  const auto file = folder_.path() / "my.bag";
  write_file(file, "");
  ReadingThread reader(growing_bytes(file, patient_recorder(control(), std::nullopt)), stop_);
  std::ofstream recorder(file, std::ios::app);
  recorder << "one\ntw" << std::flush;
  EXPECT_TRUE(soon([&] { return reader.text() == "one\ntw"; }));
  recorder << "o" << std::flush;
  EXPECT_TRUE(soon([&] { return reader.text() == "one\ntwo"; }));
  stop_ = true;
  EXPECT_EQ(reader.rest(), "one\ntwo");
}

TEST_F(GrowingLogTest, a_file_that_stops_growing_ends_as_a_log) {
  const auto file = folder_.path() / "my.log";
  write_file(file, "FLASER one\nFLASER two");
  EXPECT_EQ(ReadingThread(growing_lines(file, control(), 0.0), stop_).rest(), "FLASER one\nFLASER two");
  stop_ = false;  // the first reader has stopped
  EXPECT_EQ(ReadingThread(growing_bytes(file, patient_recorder(control(), 0.0)), stop_).rest(),
            "FLASER one\nFLASER two");
}

TEST_F(GrowingLogTest, asks_whether_a_file_is_closed_only_at_its_end) {
  const auto file = folder_.path() / "my.mcap";
  write_file(file, "one");
  int asked = 0;
  BagRecorder recorder = patient_recorder(control(), 0.0);
  recorder.is_closed = [&] {
    if (++asked == 1) std::ofstream(file, std::ios::app) << "two";
    return true;
  };
  const auto bytes = growing_bytes(file, recorder);
  std::array<char, 2> room{};
  std::string text;
  const auto read = [&] {
    const std::size_t got = bytes->read(room.data(), room.size());
    text.append(room.data(), got);
    return got;
  };
  read();
  read();
  EXPECT_EQ(text, "one");
  EXPECT_EQ(asked, 0);
  while (read() > 0) continue;
  EXPECT_EQ(text, "onetwo") << "the last bytes before the file was closed";
}

TEST_F(GrowingLogTest, knows_formats_by_content_and_before_that_by_name) {
  const auto format_of = [&](const std::string& name, const std::string& bytes = "") {
    write_file(folder_.path() / name, bytes);
    return growing_format(folder_.path() / name);
  };
  EXPECT_EQ(format_of("any", "#ROSBAG V2.0\n"), LogFormat::kRos1Bag);
  EXPECT_EQ(format_of("any", "\x89MCAP0\r\n"), LogFormat::kRos2Mcap);
  EXPECT_EQ(format_of("any",
                      "\x97"
                      "CObservation2DRangeScan"),
            LogFormat::kMrptRawlog);
  EXPECT_EQ(format_of("any", "# written by hand\n"), LogFormat::kCarmen);
  EXPECT_EQ(format_of("run.bag.active"), LogFormat::kRos1Bag);
  EXPECT_EQ(format_of("run.bag"), LogFormat::kRos1Bag);
  EXPECT_EQ(format_of("run.mcap"), LogFormat::kRos2Mcap);
  EXPECT_EQ(format_of("run.rawlog"), LogFormat::kMrptRawlog);
  EXPECT_EQ(format_of("run.rawlog.gz", "\x1f\x8b\x08"), LogFormat::kMrptRawlog);
  EXPECT_EQ(format_of("run.log"), LogFormat::kCarmen);
  EXPECT_EQ(format_of("any", std::string("SQLite format 3\0", 16)), LogFormat::kRos2Sqlite);
  EXPECT_EQ(format_of("run_0.db3"), LogFormat::kRos2Sqlite);
  EXPECT_EQ(format_of("run_0.db3", "garbage"), LogFormat::kRos2Sqlite) << "its reader refuses it";
  EXPECT_EQ(growing_format(folder_.path()), LogFormat::kRos2Folder) << "it has a .db3 file";
  EXPECT_EQ(growing_format(TemporaryFolder().path()), LogFormat::kRos2Folder) << "it is empty";
}

TEST_F(GrowingLogTest, says_which_files_cannot_be_followed) {
  const std::string database("SQLite format 3\0", 16);
  EXPECT_THAT(complaint_about("\x28\xb5\x2f\xfd"),
              HasSubstr("log is a compressed file and cannot be followed"));
  write_gzipped(folder_.path() / "run_0.db3.gz", database);
  EXPECT_THAT(sentence_of([&] { growing_format(folder_.path() / "run_0.db3.gz"); }),
              HasSubstr("run_0.db3.gz is a compressed file and cannot be followed"));
  EXPECT_THAT(sentence_of([&] { growing_format(folder_.path()); }),
              HasSubstr("has no .db3 or .mcap files, expected the folder of a ROS 2 bag"));
  const auto pipe = folder_.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR), 0);
  EXPECT_THAT(sentence_of([&] { growing_format(pipe); }),
              AllOf(HasSubstr("pipe is no regular file"), HasSubstr("Pipe it to --stdin")));
  EXPECT_THAT(sentence_of([&] { growing_format(folder_.path() / "none"); }),
              HasSubstr("none does not exist"));
}

}  // namespace
}  // namespace psi_slam
