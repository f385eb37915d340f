// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam with --save-session and --resume.
#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "../session/room_log.h"
#include "app_run.h"
#include "same_results.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;
namespace fs = std::filesystem;

class ResumeApp : public testing::Test {
 protected:
  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  std::string room_log(const std::string& name, const std::vector<std::string>& lines) {
    return write_lines(folder_.path() / name, lines).string();
  }

  void expect_refused(const std::vector<std::string>& arguments, const std::string& why) {
    const AppRun run = run_app(arguments);
    EXPECT_EQ(run.code, 2) << run.err;
    EXPECT_THAT(run.err, HasSubstr(why));
    EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << "one sentence: " << run.err;
  }

  TemporaryFolder folder_;
};

TEST_F(ResumeApp, resuming_gives_the_results_of_an_uninterrupted_run) {
  const std::string log = room_log("room.log", room_log_lines(800));
  ASSERT_EQ(run_app({log, "-q", "-o", file("whole")}).code, 0);
  const AppProcess process({log, "-o", file("part"), "--save-session", file("my.session")}, folder_.path());
  const auto began = std::chrono::steady_clock::now();
  while (!fs::exists(file("part")) && std::chrono::steady_clock::now() - began < std::chrono::seconds(60))
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.send(SIGINT);
  const AppRun interrupted = process.finish();
  EXPECT_EQ(interrupted.code, 0) << interrupted.err;
  EXPECT_THAT(interrupted.out, HasSubstr("The session is saved as " + file("my.session")));
  EXPECT_LT(Json::parse(bytes_of(file("part") + "/summary.json"))["log"]["scans"], 800);

  const AppRun resumed = run_app({"--resume", file("my.session"), log, "-o", file("resumed")});
  EXPECT_EQ(resumed.code, 0) << resumed.err;
  expect_same_results(file("whole"), file("resumed"));
  EXPECT_EQ(Json::parse(bytes_of(file("resumed") + "/summary.json"))["interrupted"], false);
}

TEST_F(ResumeApp, exports_a_session_without_its_log) {
  const std::string log = room_log("room.log", room_log_lines(150));
  ASSERT_EQ(
      run_app({log, "-q", "-o", file("first"), "--save-session", file("my.session"), "--seed", "3"}).code, 0);
  fs::remove(log);
  write_bytes(file("my.edits"), "delete scan=149 local_map=0\n");
  const AppRun run =
      run_app({"--resume", file("my.session"), "-o", file("second"), "--edits", file("my.edits"), "--set",
               "map.write_dxf=false", "--set", "map.resolution_m=0.1", "--threads", "2", "--save-session",
               file("my.session"), "--json"});
  EXPECT_EQ(run.code, 0) << run.err;
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["log"]["name"], "room.log");
  EXPECT_EQ(summary["settings"]["run.seed"], "3");
  EXPECT_EQ(summary["map"]["asked_resolution_m"], 0.1);
  EXPECT_FALSE(fs::exists(file("second") + "/map.dxf"));
  EXPECT_EQ(bytes_of(file("first") + "/trajectory.tum").empty(), false);
  EXPECT_THAT(bytes_of(file("second") + "/loops.edits"), HasSubstr("delete scan=149 local_map=0"));
  ASSERT_EQ(run_app({"--resume", file("my.session"), "-q", "-o", file("third")}).code, 0);
  EXPECT_EQ(bytes_of(file("third") + "/loops.edits"), bytes_of(file("second") + "/loops.edits"));
}

TEST_F(ResumeApp, writes_the_map_even_if_the_session_cannot_be_saved) {
  const std::string log = room_log("room.log", room_log_lines(60));
  const AppRun run = run_app({log, "-o", file("out"), "--save-session", "/proc/my.session"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("cannot write /proc/my.session"));
  EXPECT_THAT(run.out, testing::Not(HasSubstr("The session is")));
  EXPECT_TRUE(fs::exists(file("out") + "/summary.json"));
}

TEST_F(ResumeApp, wrong_usage_gives_one_sentence) {
  const std::string log = room_log("room.log", room_log_lines(60));
  const std::string other = room_log("other.log", room_log_lines(60, 80));
  const std::string session = file("my.session");
  ASSERT_EQ(run_app({log, "-q", "-o", file("out"), "--save-session", session}).code, 0);
  expect_refused({"--resume", file("none"), "-o", file("x")}, "does not exist, expected a session");
  expect_refused({"--resume", log, "-o", file("x")}, "room.log is not a session of psi-slam");
  expect_refused({"--resume", session, other, "-o", file("x")}, "other.log is not the log of the session");
  expect_refused({"--resume", session, "-o", file("x"), "--set", "front_end.node_distance_m=0.3"},
                 "front_end.node_distance_m is 0.15 in the session " + session + " and cannot become 0.3");
  expect_refused({"--resume", session, "-o", file("x"), "--seed", "9"}, "run.seed is 1 in the session");
  expect_refused({session, "-o", file("x")},
                 "my.session is a session, not a log. Resume it with psi-slam --resume");
  expect_refused({log, "-o", file("x"), "--save-session", session},
                 "the file exists. Replace it with --force");
  expect_refused({log, "-o", file("y"), "--save-session", file("none/my.session")}, "does not exist");
  expect_refused({"check", log, "--save-session", session}, "--save-session");

  const std::string bytes = bytes_of(session);
  write_bytes(session, bytes.substr(0, bytes.size() / 2));
  expect_refused({"--resume", session, "-o", file("z")}, "my.session is cut off");
  std::string flipped = bytes;
  flipped[bytes.size() / 2] ^= 1;
  write_bytes(session, flipped);
  expect_refused({"--resume", session, "-o", file("z")}, "my.session is damaged");
}

}  // namespace
}  // namespace psi_slam
