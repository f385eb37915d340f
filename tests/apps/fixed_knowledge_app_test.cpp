// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam with poses that are known from outside.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "../session/room_log.h"
#include "app_run.h"
#include "map/trajectory/trajectory_file.h"
#include "pose_graph/g2o_file.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

constexpr int kScansARound = 50;

class FixedKnowledgeApp : public testing::Test {
 protected:
  void SetUp() override { write_lines(path("room.log"), room_log_lines(60, kScansARound)); }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  AppRun map(const std::string& out, std::vector<std::string> more) const {
    more.insert(more.end(), {"-q", "-o", path(out).string()});
    return run_app(more);
  }

  /// A line with the true pose of a scan, moved along x.
  static std::string pose_line(int scan, double off_m = 0) {
    const mrpt::math::TPose2D pose = room_pose(2 * M_PI * scan / kScansARound);
    return "pose time_s=" + std::to_string(1000 + 0.2 * scan) + " x_m=" + std::to_string(pose.x + off_m) +
           " y_m=" + std::to_string(pose.y) + " yaw_deg=" + std::to_string(pose.phi * 180 / M_PI) +
           " sigma_m=0.02 sigma_deg=1\n";
  }

  TemporaryFolder folder_;
};

TEST_F(FixedKnowledgeApp, all_files_have_the_stated_frame_and_repeat_to_the_last_byte) {
  const std::string log = path("room.log").string();
  write_file(path("my.edits"), pose_line(0) + pose_line(20) + pose_line(40) + pose_line(30, 5));
  const AppRun run =
      map("a", {log, "--edits", path("my.edits").string(), "--save-session", path("s").string()});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("my.edits:4: the pose at 1006.000000 s is left out"), HasSubstr("off by 5.0")));
  ASSERT_EQ(map("b", {log, "--edits", (path("a") / "loops.edits").string()}).code, 0);
  ASSERT_EQ(map("c", {"--resume", path("s").string()}).code, 0);
  for (const char* name : {"map.pgm", "map.yaml", "trajectory.csv", "graph.g2o", "loops.edits"}) {
    const std::string bytes = read_file(path("a") / name);
    EXPECT_FALSE(bytes.empty()) << name;
    EXPECT_EQ(read_file(path("b") / name), bytes) << name;
    EXPECT_EQ(read_file(path("c") / name), bytes) << name << " of the resumed session";
  }
  const Trajectory trajectory = read_trajectory(path("a") / "trajectory.tum");
  ASSERT_EQ(trajectory.size(), 60U);
  for (const int scan : {0, 10, 25, 59}) {
    const mrpt::math::TPose2D truth = room_pose(2 * M_PI * scan / kScansARound);
    EXPECT_NEAR(trajectory[static_cast<std::size_t>(scan)].pose.x, truth.x, 0.05) << scan;
    EXPECT_NEAR(trajectory[static_cast<std::size_t>(scan)].pose.y, truth.y, 0.05) << scan;
  }
  const Json summary = Json::parse(read_file(path("a") / "summary.json"));
  EXPECT_NEAR(summary["map"]["frame"]["x_m"].get<double>(), room_pose(0).x, 0.05);
  EXPECT_THAT(summary["warnings"].dump(), HasSubstr("my.edits:4: the pose at"));
}

TEST_F(FixedKnowledgeApp, settings_must_not_change_the_stated_frame) {
  write_file(path("my.edits"), pose_line(0));
  const AppRun run =
      map("a", {path("room.log").string(), "--edits", path("my.edits").string(), "--set", "map.align=walls"});
  EXPECT_NE(run.code, 0);
  EXPECT_THAT(run.err, HasSubstr("state the frame of the map"));
}

}  // namespace
}  // namespace psi_slam
