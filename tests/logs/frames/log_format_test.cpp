// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/log_format.h"

#include <gmock/gmock.h>

#include <string>
#include <vector>

#include "log_files.h"
#include "temporary_folder.h"
#include "zstd_files.h"

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
  std::string expected_ =
      ", expected a CARMEN log or an MRPT .rawlog, plain or compressed, or a ROS bag (.bag, .db3, .mcap, or "
      "the folder of a ROS 2 bag)";
};

TEST_F(LogFormatTest, detects_carmen_by_its_messages) {
  EXPECT_EQ(format_of("# a comment\n\nFLASER 1 1.0 0 0 0 0 0 0 1 host 1\n"), LogFormat::kCarmen);
  EXPECT_EQ(format_of("PARAM robot_length 1\n"), LogFormat::kCarmen);
  EXPECT_EQ(format_of("GPS 1 2 3\nRAWLASER1 0\n"), LogFormat::kCarmen);
  write_gzipped(path_, "# comments\nROBOTLASER1 0\n");
  EXPECT_EQ(detect_log_format(path_), LogFormat::kCarmen);
}

TEST_F(LogFormatTest, detects_rawlogs_by_their_first_object) {
  EXPECT_EQ(format_of("\x91"
                      "CActionCollection"
                      "\x01"),
            LogFormat::kMrptRawlog);
  EXPECT_EQ(format_of(std::string("\x98") + "mrpt::obs::CSensoryFrame" + "\x01"), LogFormat::kMrptRawlog);
}

TEST_F(LogFormatTest, detects_bags_by_their_first_bytes_and_folders_by_their_files) {
  EXPECT_EQ(format_of("#ROSBAG V2.0\n"), LogFormat::kRos1Bag);
  EXPECT_EQ(format_of(std::string("SQLite format 3\0", 16)), LogFormat::kRos2Sqlite);
  EXPECT_EQ(format_of("\x89MCAP0\r\n"), LogFormat::kRos2Mcap);
  write_file(folder_.path() / "run_0.mcap", "");
  EXPECT_EQ(detect_log_format(folder_.path()), LogFormat::kRos2Folder);
}

TEST_F(LogFormatTest, detects_the_content_of_a_compressed_file) {
  EXPECT_EQ(format_of(zstd_frame(std::string("SQLite format 3\0", 16))), LogFormat::kRos2Sqlite);
  EXPECT_EQ(format_of(zstd_frame("\x89MCAP0\r\n")), LogFormat::kRos2Mcap);
  EXPECT_EQ(format_of(zstd_frame("PARAM robot_length 1\n")), LogFormat::kCarmen);
  EXPECT_EQ(sentence_about(zstd_frame("hello")),
            path_.string() + " has an unknown format" + expected_ + ". Convert it first");
  EXPECT_EQ(sentence_about(zstd_frame("hello").substr(0, 9)),
            path_.string() + " is cut off: its compressed data are incomplete. Fetch it again");
}

TEST_F(LogFormatTest, guesses_what_an_unknown_file_is) {
  const std::string tar = std::string(257, 'x') + "ustar";
  const std::string csm = R"({"nrays": 2, "min_theta": -1.5, "max_theta": 1.5, "readings": [1, 2]})";
  const std::string table = "time_s,a0,a1,a2,a3,a4,a5,a6,a7,a8,a9\n1,2,2,2,2,2,2,2,2,2,2\n";
  for (const auto& [bytes, guess] : std::vector<std::pair<std::string, std::string>>{
           {"PK\x03\x04 run.clf", "It is an archive. Unpack it"},
           {tar, "It is an archive. Unpack it"},
           {"#ROSBAG V1.2\n", "rosbag filter OLD.bag NEW.bag True"},
           {"psi-slam session", "Continue it with --resume"},
           {"<!DOCTYPE html>", "web page"},
           {"VERTEX_SE2 0 0 0 0\n", "pose graph"},
           {csm, "carmen-from-text.py"},
           {table, "carmen-from-text.py"},
           {"header:\n  seq: 1\nangle_min: -1.5\nranges: [1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12]\n",
            "It is text of rostopic echo. Record a bag, or use rostopic echo -p"},
           {"The option angle_min is in radians.\n", "Convert it first"},
           {"Dear robot,\nwhere are you?\n", "Convert it first"}}) {
    EXPECT_THAT(sentence_about(bytes),
                testing::StartsWith(path_.string() + " has an unknown format" + expected_));
    EXPECT_THAT(sentence_about(bytes), testing::HasSubstr(guess)) << bytes;
  }
}

TEST_F(LogFormatTest, finds_compressed_and_unpacked_files_of_a_folder) {
  const auto names = [&] {
    std::vector<std::string> found;
    for (const auto& file : files_of_bag_folder(folder_.path()))
      found.push_back(file.lexically_relative(folder_.path()).string());
    return found;
  };
  for (const char* name : {"run_2.db3.zstd", "run_10.db3", "run_3.db3", "run_3.db3.zstd", "run_4.mcap.zst"})
    write_file(folder_.path() / name, "");
  EXPECT_THAT(names(), testing::ElementsAre("run_2.db3.zstd", "run_3.db3", "run_4.mcap.zst", "run_10.db3"));
  write_file(folder_.path() / "metadata.yaml",
             "rosbag2_bagfile_information:\n  compression_format: zstd\n  compression_mode: FILE\n"
             "  relative_file_paths:\n    - run_10.db3.zstd\n    - run_2.db3.zstd\n    - run_3.db3.zstd\n"
             "    - some_folder/run_4.mcap\n    - run_5.db3.zstd\n");
  EXPECT_THAT(names(), testing::ElementsAre("run_10.db3", "run_2.db3.zstd", "run_3.db3", "run_4.mcap.zst",
                                            "run_5.db3.zstd"));
}

TEST_F(LogFormatTest, reports_empty_files_and_unknown_formats) {
  const std::string file = path_.string();
  EXPECT_EQ(sentence_about(""), file + " is empty" + expected_ + ". Fetch or record it again");
  EXPECT_EQ(sentence_about("hello\nworld\n"),
            file + " has an unknown format" + expected_ + ". Convert it first");
  EXPECT_EQ(sentence_about(std::string("FLASER 1\0", 9)),
            file + " has an unknown format" + expected_ + ". Convert it first");
  EXPECT_EQ(sentence_about("\x89PNG\r\n"), file + " has an unknown format" + expected_ +
                                               ". It is an image. Name the log that the map was made from");
  write_gzipped(path_, "");
  EXPECT_EQ(sentence_of([&] { detect_log_format(path_); }),
            file + " is empty" + expected_ + ". Fetch or record it again");
}

TEST_F(LogFormatTest, reports_missing_files_and_folders_without_a_bag) {
  EXPECT_EQ(sentence_of([&] { detect_log_format(path_); }),
            path_.string() + " does not exist, expected a log. Check the path");
  EXPECT_EQ(sentence_of([&] { detect_log_format(folder_.path()); }),
            folder_.path().string() + " is a folder" + expected_ + ". Name a log file");
  write_file(folder_.path() / "metadata.yaml", "rosbag2_bagfile_information:\n");
  EXPECT_EQ(
      sentence_of([&] { detect_log_format(folder_.path()); }),
      (folder_.path() / "metadata.yaml").string() +
          " is damaged, expected rosbag2_bagfile_information with relative_file_paths. Fetch it again, or "
          "delete it to read the bag files by their names");
}

// The folder would list itself again and again.
TEST_F(LogFormatTest, refuses_a_bag_folder_that_lists_a_folder) {
  for (const std::string& name : std::vector<std::string>{".", "..", "run/", "\"run/\\0.mcap\""}) {
    write_file(folder_.path() / "metadata.yaml",
               "rosbag2_bagfile_information:\n  version: 4\n  relative_file_paths:\n    - " + name + "\n");
    EXPECT_NE(sentence_of([&] { detect_log_format(folder_.path()); }).find("metadata.yaml is damaged"),
              std::string::npos)
        << name;
  }
}

}  // namespace
}  // namespace psi_slam
