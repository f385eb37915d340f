// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam localize.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <csignal>
#include <nlohmann/json.hpp>
#include <thread>

#include "../session/room_log.h"
#include "app_run.h"
#include "map/trajectory/trajectory_file.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// Maps the room, in the frame of the first scan. Writes the log of a faster run in the same room.
class LocalizeApp : public testing::Test {
 protected:
  void SetUp() override {
    const auto log = write_lines(folder_.path() / "room.log", room_log_lines(150, 100));
    ASSERT_EQ(run_app({log.string(), "-q", "-o", map("").string()}).code, 0);
    write_lines(folder_.path() / "new.log", room_log_lines(120, 80));
  }

  std::filesystem::path map(const std::string& name) const { return folder_.path() / "map" / name; }

  AppRun localize(const std::string& map_name, std::vector<std::string> more = {}) {
    std::vector<std::string> arguments{"localize", map(map_name).string(),
                                       (folder_.path() / "new.log").string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_app(arguments);
  }

  TemporaryFolder folder_;
};

TEST_F(LocalizeApp, finds_and_tracks_a_robot_in_both_kinds_of_map) {
  for (const std::string name : {"map.yaml", "map.gridmap.gz"}) {
    const auto out = folder_.path() / ("out-" + name);
    const AppRun run = localize(name, {"-o", out.string()});
    EXPECT_EQ(run.code, 0) << run.err << run.out;
    EXPECT_THAT(run.out, HasSubstr("Localized at the end"));
    EXPECT_THAT(bytes_of(out / "localization.csv"), HasSubstr(",tracking,"));
    const Trajectory poses = read_trajectory(out / "trajectory.tum");
    ASSERT_GT(poses.size(), 60U);
    const TimeUs begin_us = 1000LL * 1000 * 1000;
    for (const StampedPose& stamped : poses) {
      const double scan = static_cast<double>(stamped.time_us - begin_us) / 200e3;
      const auto truth = room_pose(2 * M_PI * scan / 80) - room_pose(0);
      ASSERT_LT(std::hypot(stamped.pose.x - truth.x, stamped.pose.y - truth.y), 0.1) << scan;
    }
  }
}

TEST_F(LocalizeApp, takes_a_start_and_prints_json) {
  const AppRun run = localize("map.yaml", {"--start", "0.2,-0.1,5", "--json"});
  EXPECT_EQ(run.code, 0) << run.err;
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["found"], true);
  EXPECT_EQ(summary["found_after_m"], 0);
  EXPECT_NEAR(summary["found_at"][0].get<double>(), 0, 0.05) << "the given start was only rough";
  EXPECT_NEAR(summary["found_at"][1].get<double>(), 0, 0.05);
  EXPECT_EQ(summary["localized_at_end"], true);
  EXPECT_EQ(summary["interrupted"], false);
  EXPECT_GT(summary["confidence"], 0.8);
  EXPECT_EQ(summary["lost_after_s"], nullptr);
  EXPECT_EQ(summary["tracked_share"], 1);
  EXPECT_EQ(summary["searches"], 0);
  EXPECT_EQ(summary["tracked"], 120);
}

TEST_F(LocalizeApp, a_robot_that_is_not_found_gives_exit_code_1) {
  std::vector<std::string> lines = room_log_lines(60, 80);
  for (std::string& line : lines) line = with_ranges(line, 0, kRoomBeams, "1.3");  // as in a round room
  write_lines(folder_.path() / "new.log", lines);
  const AppRun run = localize("map.yaml");
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, HasSubstr("Not found in"));
  const AppRun json = localize("map.yaml", {"--json"});
  EXPECT_EQ(json.code, 1);
  EXPECT_EQ(Json::parse(json.out)["found"], false);
  EXPECT_EQ(Json::parse(json.out)["localized_at_end"], false);
}

TEST_F(LocalizeApp, warns_if_it_was_interrupted) {
  write_lines(folder_.path() / "new.log", room_log_lines(20000, 80));
  const auto out = folder_.path() / "out";
  const AppProcess process({"localize", map("map.yaml").string(), (folder_.path() / "new.log").string(),
                            "--start", "0,0,0", "--json", "-o", out.string()},
                           folder_.path());
  while (!std::filesystem::exists(out)) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  process.send(SIGINT);
  const AppRun run = process.finish();
  const Json summary = Json::parse(run.out);
  EXPECT_EQ(summary["interrupted"], true);
  EXPECT_LT(summary["scans"], 20000);
  EXPECT_THAT(run.err, HasSubstr("interrupted: \"end of the log\" stands for the last of the " +
                                 std::to_string(summary["scans"].get<int>()) + " scans"));
}

/// The robot is found and tracked. From scan 80 on, it sees a round room that is not in the map.
TEST_F(LocalizeApp, a_robot_lost_at_the_end_gives_exit_code_1) {
  std::vector<std::string> lines = room_log_lines(120, 80);
  for (std::size_t i = 80; i < lines.size(); ++i)
    lines[i] = with_ranges(lines[i], 0, kRoomBeams, "1.3");  // as in a round room
  write_lines(folder_.path() / "new.log", lines);
  const AppRun run = localize("map.yaml", {"--start", "0,0,0"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.out, HasSubstr("Found after 0.0 m and 0.0 s at x "));
  EXPECT_THAT(run.out, HasSubstr("Lost at the end, since "));
  const AppRun json = localize("map.yaml", {"--start", "0,0,0", "--json"});
  EXPECT_EQ(json.code, 1);
  const Json summary = Json::parse(json.out);
  EXPECT_EQ(summary["found"], true);
  EXPECT_EQ(summary["localized_at_end"], false);
  EXPECT_EQ(summary["confidence"], 0);
  EXPECT_GT(summary["lost_after_s"], 16.0);
  EXPECT_LT(summary["lost_after_s"], 23.0);
  EXPECT_GT(summary["tracked_share"], 0.6);
  EXPECT_LT(summary["tracked_share"], 0.95);
  EXPECT_FALSE(summary["why_not"].get<std::string>().empty());
}

TEST_F(LocalizeApp, shows_progress_on_a_terminal) {
  const std::vector<std::string> arguments{"localize", map("map.yaml").string(),
                                           (folder_.path() / "new.log").string(), "--start", "0,0,0"};
  EXPECT_THAT(run_app(arguments, true).err, HasSubstr("\r\x1b[Klocalizing "));
  EXPECT_EQ(run_app(arguments, false).err, "");
}

TEST_F(LocalizeApp, wrong_usage_gives_one_sentence) {
  EXPECT_EQ(run_app({"localize"}).code, 2);
  EXPECT_THAT(run_app({"localize", map("map.yaml").string()}).err, HasSubstr("localize MAP LOG"));
  EXPECT_THAT(localize("map.png").err, HasSubstr("expected map.yaml or map.gridmap.gz"));
  for (const std::string start : {"1,2", "1,2,x", "1,2,3,4", "1;2;3"}) {
    const AppRun run = localize("map.yaml", {"--start", start});
    EXPECT_EQ(run.code, 2) << start;
    EXPECT_THAT(run.err, HasSubstr("X,Y,YAW_DEG")) << start;
  }
}

}  // namespace
}  // namespace psi_slam
