// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/log_format.h"

#include <string>

#include "log_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

class LogFormatTest : public testing::Test {
 protected:
  LogFormat format_of(const std::string& bytes) {
    write_file(path_, bytes);
    return detect_log_format(path_);
  }

  std::string sentence_about(const std::string& bytes) {
    return sentence_of([&] { format_of(bytes); });
  }

  TemporaryFolder folder_;
  std::filesystem::path path_ = folder_.path() / "some.file";
  std::string expected_ = ", expected an MRPT .rawlog or a CARMEN log, plain or gzipped";
};

TEST_F(LogFormatTest, knows_carmen_by_its_messages) {
  EXPECT_EQ(format_of("# a comment\n\nFLASER 1 1.0 0 0 0 0 0 0 1 host 1\n"), LogFormat::kCarmen);
  EXPECT_EQ(format_of("PARAM robot_length 1\n"), LogFormat::kCarmen);
  EXPECT_EQ(format_of("GPS 1 2 3\nRAWLASER1 0\n"), LogFormat::kCarmen);
  write_gzipped(path_, "# comments\nROBOTLASER1 0\n");
  EXPECT_EQ(detect_log_format(path_), LogFormat::kCarmen);
}

TEST_F(LogFormatTest, knows_rawlogs_by_their_first_object) {
  EXPECT_EQ(format_of("\x91"
                      "CActionCollection"
                      "\x01"),
            LogFormat::kMrptRawlog);
  EXPECT_EQ(format_of(std::string("\x98") + "mrpt::obs::CSensoryFrame" + "\x01"), LogFormat::kMrptRawlog);
}

TEST_F(LogFormatTest, says_what_else_it_found) {
  const std::string file = path_.string();
  EXPECT_EQ(sentence_about(""), file + " is empty" + expected_);
  EXPECT_EQ(sentence_about("hello\nworld\n"), file + " is neither of the formats that are read" + expected_);
  EXPECT_EQ(sentence_about(std::string("FLASER 1\0", 9)),
            file + " is neither of the formats that are read" + expected_);
  EXPECT_EQ(sentence_about("\x89PNG\r\n"), file + " is neither of the formats that are read" + expected_);
  EXPECT_EQ(sentence_about("#ROSBAG V2.0\n"), file + " is a ROS bag, which is not supported yet" + expected_);
  EXPECT_EQ(sentence_about(std::string("SQLite format 3\0", 16)),
            file + " is a ROS bag, which is not supported yet" + expected_);
  EXPECT_EQ(sentence_about("\x89MCAP0\r\n"), file + " is a ROS bag, which is not supported yet" + expected_);
  write_gzipped(path_, "");
  EXPECT_EQ(sentence_of([&] { detect_log_format(path_); }), file + " is empty" + expected_);
}

TEST_F(LogFormatTest, says_when_there_is_no_such_file) {
  EXPECT_EQ(sentence_of([&] { detect_log_format(path_); }), path_.string() + " does not exist" + expected_);
  EXPECT_EQ(sentence_of([&] { detect_log_format(folder_.path()); }),
            folder_.path().string() + " is a folder" + expected_);
  write_file(folder_.path() / "metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_EQ(sentence_of([&] { detect_log_format(folder_.path()); }),
            folder_.path().string() + " is a ROS bag, which is not supported yet" + expected_);
}

}  // namespace
}  // namespace psi_slam
