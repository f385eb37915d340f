// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam with edits of the drawn map and with another frame.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "../session/room_log.h"
#include "app_run.h"
#include "localization/reference_map.h"
#include "logs/frames/pose_operations.h"
#include "map/trajectory/trajectory_file.h"
#include "pose_graph/g2o_file.h"
#include "temporary_folder.h"
#include "test_files.h"
#include "zone_corners.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

class MapEditsApp : public testing::Test {
 protected:
  void SetUp() override { write_lines(path("room.log"), room_log_lines(60, 50)); }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  AppRun map(const std::string& out, std::vector<std::string> more) const {
    more.insert(more.end(), {"-q", "-o", path(out).string()});
    return run_app(more);
  }

  TemporaryFolder folder_;
};

TEST_F(MapEditsApp, edits_change_all_files_and_repeat_to_the_last_byte) {
  const std::string log = path("room.log").string();
  write_file(path("my.edits"),
             "wall line=-1,-0.5;-1,0.5\nunknown polygon=-3,-0.5;-2.5,-0.5;-2.5,0.5\n"
             "keep_out polygon=-1,0;-0.5,0;-0.5,0.5\nslow polygon=-2,0;-1.5,0;-1.5,0.5 percent=30\n"
             "erase polygon=90,90;91,90;91,91\n");
  const std::string edits = path("my.edits").string();
  const std::string gpkg = "map.write_gpkg=true";
  const AppRun run = map("a", {log, "--edits", edits, "--save-session", path("s").string(), "--set", gpkg});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, HasSubstr("an edit was not made: erase at 90,90: no cell of the map lies there"));
  ASSERT_EQ(map("b", {log, "--edits", (path("a") / "loops.edits").string(), "--set", gpkg}).code, 0);
  ASSERT_EQ(map("c", {"--resume", path("s").string(), "--set", gpkg}).code, 0);
  for (const char* name : {"map.pgm", "map.yaml", "map.gridmap.gz", "map.png", "map.svg", "map.dxf",
                           "map.gpkg", "keepout_mask.pgm", "keepout_mask.yaml", "speed_mask.pgm",
                           "speed_mask.yaml", "zones.txt", "loops.edits"}) {
    const std::string bytes = read_file(path("a") / name);
    EXPECT_FALSE(bytes.empty()) << name;
    EXPECT_EQ(read_file(path("b") / name), bytes) << name;
    EXPECT_EQ(read_file(path("c") / name), bytes) << name << " of the resumed session";
  }
  const auto edited = read_map_file(path("a") / "map.yaml");
  EXPECT_LT(edited.getPos(-1, 0), 0.3F);
  EXPECT_NEAR(edited.getPos(-2.6F, 0), 0.5F, 0.1F);
}

TEST_F(MapEditsApp, edits_stay_on_their_walls_when_the_frame_turns) {
  const std::string log = path("room.log").string();
  write_file(path("my.edits"), "keep_out polygon=-1,0;-0.5,0;-0.5,0.5\n");
  ASSERT_EQ(map("plain", {log, "--edits", path("my.edits").string()}).code, 0);
  const std::string saved = (path("plain") / "loops.edits").string();
  EXPECT_THAT(read_file(saved), HasSubstr("keep_out polygon=-1,0;-0.5,0;-0.5,0.5 frame=0,0,0"));
  ASSERT_EQ(map("turned", {log, "--edits", saved, "--set", "map.align=90", "--set", "map.origin_x_m=2"}).code,
            0);
  const auto corners = corners_of_zones(path("turned").string());
  ASSERT_EQ(corners.size(), 3U);
  EXPECT_NEAR(corners[0].x, -2, 1e-5);
  EXPECT_NEAR(corners[0].y, -1, 1e-5);
  write_file(path("late.edits"), "keep_out polygon=-1,0;-0.5,0;-0.5,0.5 frame=0,0,0 scan=900\n");
  EXPECT_THAT(map("late", {log, "--edits", path("late.edits").string()}).err,
              HasSubstr("add keep-out zone: its scan 900 is not mapped, the last scan is 59"));
}

TEST_F(MapEditsApp, every_file_has_the_frame_of_the_settings) {
  const std::string log = path("room.log").string();
  ASSERT_EQ(map("plain", {log}).code, 0);
  ASSERT_EQ(map("turned", {log, "--set", "map.align=30", "--set", "map.origin_x_m=2"}).code, 0);
  const mrpt::math::TPose2D turned_T_plain(-2, 0, M_PI / 6);
  const Trajectory before = read_trajectory(path("plain") / "trajectory.tum");
  const Trajectory after = read_trajectory(path("turned") / "trajectory.tum");
  const PoseGraph graph = read_pose_graph(path("turned") / "graph.g2o").graph;
  ASSERT_EQ(after.size(), before.size());
  const auto expected = turned_T_plain + before.back().pose;
  EXPECT_NEAR(after.back().pose.x, expected.x, 1e-5);
  EXPECT_NEAR(after.back().pose.y, expected.y, 1e-5);
  EXPECT_NEAR(graph.pose(0).x, after.front().pose.x, 1e-5);
  EXPECT_NEAR(graph.pose(0).phi, after.front().pose.phi, 1e-5);
  const auto frame = Json::parse(read_file(path("turned") / "summary.json"))["map"]["frame"];
  EXPECT_NEAR(frame["x_m"].get<double>(), -2, 1e-9);
  EXPECT_NEAR(frame["yaw_deg"].get<double>(), 30, 1e-6);
  // The drawn map has turned, too.
  const AppRun diff = run_app({"diff", path("plain").string(), path("turned").string(), "--json"});
  const auto alignment = Json::parse(diff.out)["alignment"];
  const auto plain_T_turned = inverse(turned_T_plain);
  EXPECT_NEAR(alignment["x_m"].get<double>(), plain_T_turned.x, 0.05) << diff.err;
  EXPECT_NEAR(alignment["y_m"].get<double>(), plain_T_turned.y, 0.05);
  EXPECT_NEAR(alignment["yaw_rad"].get<double>(), plain_T_turned.phi, 0.01);
  EXPECT_THAT(map("wrong", {log, "--set", "map.align=sideways"}).err, HasSubstr("expected walls, none"));
}

}  // namespace
}  // namespace psi_slam
