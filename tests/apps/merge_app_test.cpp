// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam merge.
#include <gmock/gmock.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "../session/room_log.h"
#include "app_run.h"
#include "command_line.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "same_results.h"
#include "session/edit_journal.h"
#include "session/settings.h"
#include "temporary_folder.h"
#include "test_files.h"
#include "zone_corners.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// Writes the logs of two runs in the room. The second run is faster and begins after a quarter of the round.
/// The time stamps of both runs overlap.
class MergeApp : public testing::Test {
 protected:
  void SetUp() override {
    const auto lines = room_log_lines(140, 80);
    write_lines(folder_.path() / "first.log", room_log_lines(120, 100));
    write_lines(folder_.path() / "second.log", {lines.begin() + kFirst, lines.end()});
  }

  std::string file(const std::string& name) const { return (folder_.path() / name).string(); }

  AppRun merge(const std::vector<std::string>& inputs, const std::string& out,
               const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"merge"};
    for (const std::string& input : inputs) arguments.push_back(file(input));
    arguments.insert(arguments.end(), {"-o", file(out)});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_app(arguments);
  }

  /// Expects poses of the second run within 5 cm of the true poses, relative to the first run's first scan.
  void expect_second_run_in_place(const std::string& out) {
    const Trajectory second = read_trajectory(file(out) + "/trajectory-2.tum");
    ASSERT_EQ(second.size(), 120U);
    for (std::size_t i = 0; i < second.size(); ++i) {
      const auto truth = room_pose(2 * M_PI * static_cast<double>(i + kFirst) / 80) - room_pose(0);
      ASSERT_LT(std::hypot(second[i].pose.x - truth.x, second[i].pose.y - truth.y), 0.05) << i;
    }
  }

  static std::string default_text(const std::string& name) {
    const auto table = default_settings();
    for (const OptionSection& section : table->sections())
      for (const Option& option : section.options)
        if (option.name() == name) return option.text();
    return "";
  }

  static std::vector<Frame> frames_of_log(const std::string& path) {
    std::vector<Frame> frames;
    const auto log = open_log(path, {});
    while (std::optional<Frame> frame = log->next()) frames.push_back(*std::move(frame));
    return frames;
  }

  static constexpr std::size_t kFirst = 20;
  TemporaryFolder folder_;
};

TEST_F(MergeApp, finds_the_start_of_the_second_run_and_makes_one_map) {
  const AppRun run = merge({"first.log", "second.log"}, "out", {"--json"});
  ASSERT_EQ(run.code, 0) << run.err;
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["log"]["name"], "first.log + second.log");
  EXPECT_EQ(summary["log"]["scans"], 240);
  EXPECT_EQ(summary["drives"],
            Json::parse(R"([{"first_scan": 0, "scans": 120}, {"first_scan": 120, "scans": 120}])"));
  EXPECT_EQ(summary["log"]["stamps_back"], 0) << "runs may overlap in time";
  EXPECT_NEAR(summary["log"]["duration_s"].get<double>(), 2 * 119 * 0.2, 1e-6);
  EXPECT_EQ(read_trajectory(file("out") + "/trajectory-1.tum").size(), 120U);
  EXPECT_EQ(read_trajectory(file("out") + "/trajectory.tum").size(), 240U);
  expect_second_run_in_place("out");
  const double way_m = summary["path_length_m"];
  const double odometry_m = summary["log"]["odometry_length_m"];
  EXPECT_NEAR(way_m, odometry_m, 0.05 * odometry_m) << "the way between two runs does not count";
}

TEST_F(MergeApp, takes_a_start) {
  const auto start = room_pose(2 * M_PI * kFirst / 80) - room_pose(0);
  const auto text = std::to_string(start.x + 0.4) + ',' + std::to_string(start.y - 0.3) + ',' +
                    std::to_string(start.phi * 180 / M_PI + 8);
  const AppRun run = merge({"first.log", "second.log"}, "out", {"--start", text});
  ASSERT_EQ(run.code, 0) << run.err;
  expect_second_run_in_place("out");
  const AppRun wrong = merge({"first.log", "second.log"}, "wrong", {"--start", "40,40,0"});
  EXPECT_EQ(wrong.code, 2);
  EXPECT_THAT(wrong.err, HasSubstr("second.log does not begin near --start"));
  EXPECT_TRUE(std::filesystem::is_empty(file("wrong"))) << "no half map";
}

TEST_F(MergeApp, edits_of_the_drawn_map_follow_their_runs) {
  write_file(file("first.edits"), "keep_out polygon=-2,0;-1,0;-1,1\n");
  write_file(file("second.edits"),
             "keep_out polygon=-1,0;-0.5,0;-0.5,0.5\ncrop polygon=-5,-5;5,-5;5,5;-5,5\n");
  for (const std::string name : {"first", "second"})
    ASSERT_EQ(run_app({file(name + ".log"), "-q", "-o", file(name), "--save-session", file(name + ".session"),
                       "--edits", file(name + ".edits"), "--set",
                       name == "second" ? "map.align=30" : "map.align=none"})
                  .code,
              0);
  const AppRun run = merge({"first.session", "second.session"}, "merged", {"--save-session", file("both")});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("second.session: its crop of the drawn map is left out"));
  const auto corners = corners_of_zones(file("merged"));
  ASSERT_EQ(corners.size(), 6U);
  EXPECT_EQ(corners[0], mrpt::math::TPoint2D(-2, 0));
  const mrpt::math::TPose2D first_T_second = room_pose(2 * M_PI * kFirst / 80) - room_pose(0);
  const mrpt::math::TPose2D second_T_turned(0, 0, -M_PI / 6);
  const auto expected = (first_T_second + second_T_turned).composePoint({-1, 0});
  EXPECT_LT((corners[3] - expected).norm(), 0.05) << "at its place in the room";
  ASSERT_EQ(run_app({"--resume", file("both"), "-q", "-o", file("again")}).code, 0);
  expect_same_results(file("merged"), file("again"));
}

TEST_F(MergeApp, says_which_edits_of_the_drawn_map_have_no_place) {
  Settings settings;
  settings.map_frame.align = MapFrameOptions::kWalls;
  MappingSession unfinished(file("second.log"), settings);
  unfinished.add_edits(EditJournal::parse("erase polygon=0,0;1,0;1,1\n", "my.edits"));
  while (unfinished.step()) {
  }
  unfinished.save(file("second.session"));  // without the frame, which only the finished map has
  const AppRun run = merge({"first.log", "second.session"}, "merged");
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err,
              HasSubstr("second.session: 1 edit of the drawn map is left out, because the frame of the map"));
  EXPECT_FALSE(std::filesystem::exists(file("merged") + "/loops.edits"));

  Settings slow;
  MappingSession first(file("first.log"), slow);
  first.add_edits(EditJournal::parse("slow polygon=0,0;1,0;1,1 percent=40\n", "my.edits"));
  first.step();
  first.save(file("percent.session"));
  MappingSession second(file("second.log"), slow);
  second.add_edits(EditJournal::parse("slow polygon=0,0;1,0;1,1 max_speed_mps=1\n", "my.edits"));
  second.step();
  second.save(file("speed.session"));
  const AppRun mixed = merge({"percent.session", "speed.session"}, "mixed");
  EXPECT_EQ(mixed.code, 2);
  EXPECT_THAT(mixed.err, HasSubstr("the zones of these runs cannot be combined: the edits limit the speed"));
}

TEST_F(MergeApp, sessions_with_edits_give_the_same_map) {
  for (const std::string name : {"first", "second"})
    ASSERT_EQ(
        run_app({file(name + ".log"), "-q", "-o", file(name), "--save-session", file(name + ".session")})
            .code,
        0);
  ASSERT_EQ(merge({"first.log", "second.log"}, "of_logs").code, 0);
  const AppRun of_sessions =
      merge({"first.session", "second.session"}, "of_sessions", {"--save-session", file("both.session")});
  ASSERT_EQ(of_sessions.code, 0);
  EXPECT_EQ(of_sessions.err, "") << "their settings are the same";
  expect_same_results(file("of_logs"), file("of_sessions"));
  ASSERT_EQ(run_app({"--resume", file("both.session"), "-q", "-o", file("resumed")}).code, 0);
  expect_same_results(file("of_logs"), file("resumed"));

  const AppRun three = merge({"both.session", "second.log"}, "three", {"--json"});
  ASSERT_EQ(three.code, 0) << three.err;
  EXPECT_EQ(Json::parse(three.out)["drives"].size(), 3U);
}

TEST_F(MergeApp, warns_of_changed_settings_of_a_session) {
  const auto save = [&](const std::string& name, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments{file(name + ".log"),    "-q", "-o", file(name), "--save-session",
                                       file(name + ".session")};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    ASSERT_EQ(run_app(arguments).code, 0);
  };
  save("first", {"map.resolution_m=0.1", "run.threads=1"});
  save("second", {"front_end.node_rotation_deg=7.5", "log.min_range_m=0.05", "run.seed=9", "psi.psi_2=2"});
  const AppRun run = merge({"first.session", "second.session"}, "out");
  EXPECT_EQ(run.code, 0);
  EXPECT_EQ(run.err, "psi-slam: " + file("second.session") +
                         " was mapped with other settings and is mapped again with the current settings: "
                         "front_end.node_rotation_deg was 7.5 and is " +
                         default_text("front_end.node_rotation_deg") + ", log.min_range_m was 0.05 and is " +
                         default_text("log.min_range_m") + ", psi.psi_2 was 2 and is " +
                         default_text("psi.psi_2") + ", and 1 more\n");
}

/// In each corrected CARMEN log, time stamps must increase, and odometry must move less than 0.5 m per scan.
TEST_F(MergeApp, writes_a_corrected_log_for_each_run) {
  ASSERT_EQ(merge({"first.log", "second.log"}, "out").code, 0);
  EXPECT_FALSE(std::filesystem::exists(file("out") + "/trajectory.carmen"));
  for (const std::string drive : {"1", "2"}) {
    SCOPED_TRACE(drive);
    const std::string name = file("out") + "/trajectory-" + drive;
    const auto frames = frames_of_log(name + ".carmen");
    ASSERT_EQ(frames.size(), 120U);
    for (std::size_t i = 1; i < frames.size(); ++i) {
      EXPECT_GT(frames[i].time_us, frames[i - 1].time_us);
      const auto moved = frames[i].odom_T_robot - frames[i - 1].odom_T_robot;
      EXPECT_LT(std::hypot(moved.x, moved.y), 0.5);
    }
    const Trajectory poses = read_trajectory(name + ".carmen");
    const Trajectory tum = read_trajectory(name + ".tum");
    for (std::size_t i = 0; i < poses.size(); ++i) EXPECT_NEAR(poses[i].pose.x, tum[i].pose.x, 1e-6);
  }
  EXPECT_THAT(bytes_of(file("out") + "/report.html"), HasSubstr("href=\"trajectory-2.carmen\""));
  // Mapping one run into the same folder removes the files of the two runs.
  ASSERT_EQ(run_app({file("first.log"), "-q", "-o", file("out"), "--force"}).code, 0);
  EXPECT_TRUE(std::filesystem::exists(file("out") + "/trajectory.carmen"));
  EXPECT_FALSE(std::filesystem::exists(file("out") + "/trajectory-1.carmen"));
  EXPECT_FALSE(std::filesystem::exists(file("out") + "/trajectory-2.tum"));
}

TEST_F(MergeApp, shows_the_progress_of_the_search_for_the_start) {
  const AppRun run = run_app({"merge", file("first.log"), file("second.log"), "-o", file("out")}, true);
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("\r\x1b[Kfinding where second.log begins     0 %"));
}

TEST_F(MergeApp, rejects_another_building_and_writes_nothing) {
  std::vector<std::string> lines = room_log_lines(60, 80);
  for (std::string& line : lines) line = with_ranges(line, 0, kRoomBeams, "1.3");  // as in a round room
  write_lines(folder_.path() / "second.log", lines);
  const AppRun run = merge({"first.log", "second.log"}, "out", {"--save-session", file("both.session")});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("second.log cannot be placed in the map of the runs before it: "));
  EXPECT_EQ(run.err.find('\n'), run.err.size() - 1) << run.err;
  EXPECT_TRUE(std::filesystem::is_empty(file("out")));
  EXPECT_FALSE(std::filesystem::exists(file("both.session")));
}

/// With loop closing switched off, no loop joins the runs.
TEST_F(MergeApp, names_the_run_that_no_loop_joins) {
  const AppRun run =
      merge({"first.log", "second.log", "first.log"}, "out", {"--set", "loop_closure.enabled=false"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("second.log cannot be merged: no loop joins it to the other runs"));
}

TEST_F(MergeApp, merges_a_damaged_first_run_up_to_the_damage) {
  std::ofstream(file("first.log"), std::ios::app) << "FLASER 181 1.0 2.0";
  const AppRun run =
      merge({"first.log", "second.log"}, "out", {"-q", "--save-session", file("both.session")});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("first.log:121"));
  const AppRun resumed = run_app({"--resume", file("both.session"), "-q", "-o", file("resumed")});
  EXPECT_EQ(resumed.code, run.code);
  EXPECT_EQ(resumed.err, run.err);
  EXPECT_THAT(bytes_of(file("out") + "/report.html"), HasSubstr("first.log:121"));
  expect_second_run_in_place("out");
}

TEST_F(MergeApp, wrong_usage_gives_one_sentence) {
  EXPECT_THAT(run_app({"merge", file("first.log"), "-o", file("x")}).err,
              HasSubstr("merge FIRST SECOND -o DIR"));
  EXPECT_THAT(merge({"first.log", "second.log"}, "x", {"--start", "1,2"}).err, HasSubstr("--start 1,2"));
  EXPECT_THAT(merge({"first.log", "second.log", "first.log"}, "x", {"--start", "1,2,3"}).err,
              HasSubstr("--start needs exactly two runs"));
  EXPECT_THAT(run_app({"merge", file("first.log"), file("second.log")}).err, HasSubstr("-o DIR"));
  EXPECT_THAT(merge({"first.log", "none.log"}, "x").err, HasSubstr("none.log does not exist"));
  EXPECT_THAT(run_app({"marge", "a", "b"}).err, HasSubstr("did you mean \"merge\""));
}

}  // namespace
}  // namespace psi_slam
