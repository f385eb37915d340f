// SPDX-License-Identifier: BSD-3-Clause
// No output of psi-slam may replace an input or another output.
#include "files_to_write.h"

#include <gmock/gmock.h>
#include <sys/stat.h>

#include "../session/room_log.h"
#include "app_run.h"
#include "map/report/output_folder.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FilesToWrite : public testing::Test {
 protected:
  FilesToWrite() : log_(write_lines(file("room.log"), room_log_lines(20)).string()) {}

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  /// Expects that the arguments are refused with this sentence, and that no file of the test changes.
  void expect_refused(const std::vector<std::string>& arguments, const std::string& sentence) const {
    SCOPED_TRACE(sentence);
    std::map<fs::path, std::string> before;
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder_.path()))
      if (fs::is_regular_file(entry.symlink_status())) before[entry.path()] = bytes_of(entry.path());
    const AppRun run = run_app(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr(sentence));
    for (const auto& [path, bytes] : before) EXPECT_EQ(bytes_of(path), bytes) << path;
  }

  TemporaryFolder folder_;
  std::string log_;
};

TEST_F(FilesToWrite, a_session_or_a_journal_never_replaces_an_input) {
  write_bytes(file("my.ini"), "[map]\nresolution_m = 0.1\n");
  write_bytes(file("my.edits"), "");
  fs::create_symlink("room.log", file("link"));
  const std::string out = file("out");
  for (const char* const option : {"--save-session", "--journal"}) {
    expect_refused({log_, "-o", out, option, file("link"), "--force"},
                   "this is the log, which would be lost");
    expect_refused({log_, "-o", out, "-c", file("my.ini"), option, file("my.ini"), "--force"},
                   "this is the settings file");
    expect_refused({log_, "-o", out, "--edits", file("my.edits"), option, file("my.edits"), "--force"},
                   "this is the file of edits");
  }
  expect_refused({"live", "--follow", log_, "-o", out, "--save-session", log_, "--force"}, "this is the log");
  expect_refused({"merge", log_, log_, "-o", out, "--save-session", log_, "--force"}, "this is the input");
  fs::create_directory(file("bag"));
  write_bytes(file("bag/bag_0.db3"), "x");
  expect_refused({file("bag"), "-o", out, "--save-session", file("bag/bag_0.db3"), "--force"},
                 "this is a file of the log");
  EXPECT_FALSE(fs::exists(out));
}

TEST_F(FilesToWrite, a_merged_session_may_replace_the_session_it_grows) {
  ASSERT_EQ(run_app({log_, "-q", "-o", file("out"), "--save-session", file("my.session")}).code, 0);
  const AppRun run = run_app({"merge", file("my.session"), log_, "-q", "-o", file("both"), "--start", "0,0,0",
                              "--save-session", file("my.session"), "--force"});
  EXPECT_EQ(run.err.find("would be lost"), std::string::npos) << run.err;
}

TEST_F(FilesToWrite, results_never_replace_an_input) {
  fs::create_directory(file("out"));
  fs::copy_file(log_, file("out/trajectory.carmen"));
  expect_refused({file("out/trajectory.carmen"), "-o", file("out"), "--force"},
                 "the results in " + file("out") + " would replace the log");
  const AppRun elsewhere = run_app({file("out/trajectory.carmen"), "-q", "-o", file("other")});
  EXPECT_EQ(elsewhere.code, 0) << elsewhere.err;
}

TEST_F(FilesToWrite, a_session_is_never_a_result) {
  fs::create_directory(file("out"));
  expect_refused({log_, "-o", file("out"), "--save-session", file("out/frames.csv")},
                 "have a file of this name");
  const AppRun beside = run_app({log_, "-q", "-o", file("out"), "--save-session", file("out/my.session")});
  EXPECT_EQ(beside.code, 0) << beside.err;
  EXPECT_TRUE(fs::exists(file("out/my.session")));
}

TEST_F(FilesToWrite, every_file_of_a_run_is_known_as_a_result) {
  ASSERT_EQ(run_app({log_, "-q", "-o", file("out")}).code, 0);
  for (const fs::directory_entry& entry : fs::directory_iterator(file("out")))
    EXPECT_TRUE(OutputFolder::is_result(entry.path().filename().string())) << entry.path();
}

TEST_F(FilesToWrite, a_session_never_replaces_a_device) {
  expect_refused({log_, "-o", file("out"), "--save-session", "/dev/null", "--force"},
                 "is a device or a pipe");
}

TEST_F(FilesToWrite, a_journal_may_lie_in_an_empty_output_folder) {
  fs::create_directory(file("out"));
  const AppRun run = run_app({log_, "-q", "-o", file("out"), "--journal", file("out/my.journal")});
  EXPECT_EQ(run.code, 0) << run.err;
}

TEST_F(FilesToWrite, two_runs_do_not_write_to_one_folder) {
  const OutputFolder held = OutputFolder::prepare(file("out"), false);
  expect_refused({log_, "-o", file("out")}, "another run is writing to the output folder");
  expect_refused({log_, "-o", file("out"), "--force"}, "another run is writing to the output folder");
}

TEST_F(FilesToWrite, a_sweep_leaves_the_results_of_a_run_alone) {
  ASSERT_EQ(run_app({log_, "-q", "-o", file("out")}).code, 0);
  expect_refused({"sweep", log_, "-o", file("out")}, "is not empty and holds no sweep");
}

TEST_F(FilesToWrite, folders_that_cannot_be_made) {
  fs::create_symlink("nowhere", file("dangling"));
  fs::create_symlink("loop", file("loop"));
  expect_refused({log_, "-o", file("dangling")}, "is a link that leads nowhere");
  expect_refused({log_, "-o", file("loop")}, "is a link that leads nowhere");
  expect_refused({log_, "-o", file(std::string(300, 'x'))}, "File name too long");
}

TEST_F(FilesToWrite, a_pipe_is_no_log) {
  ASSERT_EQ(::mkfifo(file("pipe").c_str(), 0600), 0);
  expect_refused({file("pipe"), "-o", file("out")}, "is a pipe or a device, expected");
  expect_refused({"check", file("pipe")}, "is a pipe or a device, expected");
  expect_refused({"--resume", file("pipe"), "-o", file("out")}, "is a pipe or a device, expected");
}

TEST_F(FilesToWrite, without_a_folder_results_go_to_the_next_free_one_in_the_current_folder) {
  fs::create_directory(file("here"));
  const auto run_here = [&](const std::vector<std::string>& arguments) {
    const AppProcess process(arguments, folder_.path(), [&] {
      if (::chdir(file("here").c_str()) != 0) ::_exit(126);
    });
    const AppRun run = process.finish();
    EXPECT_EQ(run.code, 0) << run.err;
    return run.err;
  };
  EXPECT_THAT(run_here({log_}), HasSubstr("the results go to the folder room-map. Name another one with -o"));
  EXPECT_TRUE(fs::exists(file("here/room-map/map.png")));
  EXPECT_THAT(run_here({"../room.log", "-q"}), HasSubstr("the folder room-map-2."));
  const std::string first = bytes_of(file("here/room-map/summary.json"));
  EXPECT_THAT(run_here({log_}), HasSubstr("the folder room-map-3."));
  EXPECT_EQ(bytes_of(file("here/room-map/summary.json")), first);
  EXPECT_THAT(run_here({log_, "--force", "--set", "map.resolution_m=0.1"}),
              HasSubstr("the folder room-map."));
  EXPECT_NE(bytes_of(file("here/room-map/summary.json")), first);
  EXPECT_FALSE(fs::exists(file("here/room-map-4")));
  EXPECT_EQ(run_here({log_, "-o", "named"}), "");
  EXPECT_EQ(run_app({file("missing.log")}).code, 2);
}

TEST(DefaultOutputFolder, has_the_name_of_the_log_without_its_endings) {
  for (const auto& [log, folder] :
       std::vector<std::pair<std::string, std::string>>{{"/logs/intel.clf.gz", "intel-map"},
                                                        {"fr079.clf.bz2", "fr079-map"},
                                                        {"run_0.db3.zstd", "run_0-map"},
                                                        {"/bags/tour/", "tour-map"},
                                                        {"notes.txt", "notes-map"},
                                                        {"2006-01.rawlog", "2006-01-map"}}) {
    CommandLine line;
    line.log = log;
    EXPECT_EQ(default_output_folder(line), folder) << log;
  }
  CommandLine line;
  line.resume = "my.session";
  EXPECT_EQ(default_output_folder(line), "my-map");
}

}  // namespace
}  // namespace psi_slam
