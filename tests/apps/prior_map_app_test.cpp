// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam with a prior map.
#include <gmock/gmock.h>

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "../session/room_drawing.h"
#include "../session/room_log.h"
#include "app_run.h"
#include "localization/reference_map.h"
#include "map/trajectory/trajectory_file.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

constexpr int kScansOfRound = 50;

class PriorMapApp : public testing::Test {
 protected:
  void SetUp() override { write_lines(log_, room_log_lines(60, kScansOfRound)); }

  std::filesystem::path path(const std::string& name) const { return folder_.path() / name; }

  AppRun map(const std::string& out, std::vector<std::string> more) const {
    more.insert(more.end(), {"-q", "-o", path(out).string()});
    return run_app(more);
  }

  /// Maps another log of the room in the frame of the room, with these edits of the drawn map.
  std::string prior_map(const std::string& edits) const {
    write_lines(path("prior.log"), room_log_lines(100, 100));
    std::string lines;
    for (const int scan : {0, 30, 60}) {
      const mrpt::math::TPose2D pose = room_pose(2 * M_PI * scan / 100);
      lines += "pose time_s=" + std::to_string(1000 + 0.2 * scan) + " x_m=" + std::to_string(pose.x) +
               " y_m=" + std::to_string(pose.y) + " yaw_deg=" + std::to_string(pose.phi * 180 / M_PI) +
               " sigma_m=0.01 sigma_deg=0.5\n";
    }
    write_file(path("prior.edits"), lines + edits);
    const AppRun run = map("prior", {path("prior.log").string(), "--edits", path("prior.edits").string()});
    EXPECT_EQ(run.code, 0) << run.err;
    return "prior.map=" + (path("prior") / "map.yaml").string();
  }

  /// Largest distance of a pose of the run from its true place in the room.
  double worst_m(const std::string& out) const {
    const Trajectory trajectory = read_trajectory(path(out) / "trajectory.tum");
    EXPECT_EQ(trajectory.size(), 60U);
    double worst = 0;
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      const mrpt::math::TPose2D truth = room_pose(2 * M_PI * static_cast<double>(i) / kScansOfRound);
      worst = std::max(worst, std::hypot(trajectory[i].pose.x - truth.x, trajectory[i].pose.y - truth.y));
    }
    return worst;
  }

  void expect_same_files(const std::string& a, const std::string& b) const {
    for (const char* name : {"map.pgm", "map.yaml", "trajectory.csv", "graph.g2o"}) {
      const std::string bytes = read_file(path(a) / name);
      EXPECT_FALSE(bytes.empty()) << name;
      EXPECT_EQ(read_file(path(b) / name), bytes) << name << " of " << b;
    }
  }

  TemporaryFolder folder_;
  const std::filesystem::path log_ = folder_.path() / "room.log";
};

TEST_F(PriorMapApp, the_run_gets_the_frame_of_the_prior_map_and_repeats_to_the_last_byte) {
  const std::string prior = prior_map("");
  const AppRun run = map(
      "a", {log_.string(), "--set", prior, "--set", "run.threads=1", "--save-session", path("s").string()});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, Not(HasSubstr("map.yaml")));
  EXPECT_LT(worst_m("a"), 0.06);
  ASSERT_EQ(map("b", {log_.string(), "--set", prior, "--set", "run.threads=3"}).code, 0);
  expect_same_files("a", "b");
  ASSERT_EQ(map("c", {"--resume", path("s").string()}).code, 0);
  expect_same_files("a", "c");
  write_file(path("prior") / "map.yaml", read_file(path("prior") / "map.yaml") + "# moved\n");
  const AppRun changed = map("d", {"--resume", path("s").string()});
  ASSERT_EQ(changed.code, 0);
  EXPECT_THAT(changed.err, HasSubstr("this prior map has changed since the session was saved"));
}

TEST_F(PriorMapApp, walls_that_are_not_there_are_named_and_missing_furniture_is_not) {
  // The prior map lacks the pillar, and has a wall that the scans see through.
  const std::string prior =
      prior_map("erase polygon=4.7,2.7;7.7,2.7;7.7,5.3;4.7,5.3\nwall line=9,3;9,5 width_m=0.1\n");
  const AppRun run = map("a", {log_.string(), "--set", prior});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("the scans see free space at 1 wall of this map: 2."),
                             HasSubstr("m from x 9.0 m, y "), HasSubstr("to x 9.0 m, y ")));
  EXPECT_LT(worst_m("a"), 0.06);
}

TEST_F(PriorMapApp, a_drawing_without_the_pillar_states_the_frame) {
  write_file(path("room.dxf"), room_drawing(kMillimetres));
  write_file(path("unitless.dxf"), room_drawing(""));
  const auto with = [&](const std::string& file) { return "prior.map=" + path(file).string(); };
  const AppRun run = map("a", {log_.string(), "--set", with("room.dxf"), "--set", "prior.layers=WALLS"});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(Not(HasSubstr("left out")), Not(HasSubstr("contradict"))));
  EXPECT_LT(worst_m("a"), 0.06 + std::hypot(kRoomDrawingShift_m, kRoomDrawingShift_m));
  const AppRun unitless = map("b", {log_.string(), "--set", with("unitless.dxf")});
  EXPECT_EQ(unitless.code, 2);
  EXPECT_THAT(unitless.err, HasSubstr("states no unit of length"));
  ASSERT_EQ(map("c", {log_.string(), "--set", with("unitless.dxf"), "--set", "prior.layers=WALLS", "--set",
                      "prior.metres_per_unit=0.001"})
                .code,
            0);
  EXPECT_EQ(read_file(path("c") / "trajectory.csv"), read_file(path("a") / "trajectory.csv"));
  const AppRun layerless = map("d", {log_.string(), "--set", with("room.dxf"), "--set", "prior.layers=A"});
  EXPECT_EQ(layerless.code, 2);
  EXPECT_THAT(layerless.err, HasSubstr("Its layers are: DIMENSIONS, WALLS"));
  const AppRun misspelt =
      map("f", {log_.string(), "--set", with("room.dxf"), "--set", "prior.layers=WALLS,DIMENSION"});
  EXPECT_EQ(misspelt.code, 2);
  EXPECT_THAT(misspelt.err,
              HasSubstr("prior.layers names the layer DIMENSION, which has nothing drawn on it"));
  const AppRun huge =
      map("e", {log_.string(), "--set", with("room.dxf"), "--set", "prior.metres_per_unit=1"});
  EXPECT_EQ(huge.code, 2);
  EXPECT_THAT(huge.err, HasSubstr("12000.0 m x 9500.0 m"));
}

TEST_F(PriorMapApp, a_session_with_a_drawing_and_edits_is_resumed_to_the_same_bytes) {
  write_file(path("room.dxf"), room_drawing(kMillimetres));
  write_file(path("wall.edits"), "wall line=9,3;9,5 width_m=0.1\n");
  const std::vector<std::string> drawing{"--set", "prior.map=" + path("room.dxf").string(), "--set",
                                         "prior.layers=WALLS"};
  const auto with_drawing = [&](std::vector<std::string> words) {
    words.insert(words.end(), drawing.begin(), drawing.end());
    return words;
  };
  const AppRun run = map("a", with_drawing({log_.string(), "--edits", path("wall.edits").string(),
                                            "--save-session", path("s").string()}));
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, Not(HasSubstr("left out")));
  ASSERT_EQ(map("plain", with_drawing({log_.string()})).code, 0);
  EXPECT_NE(read_file(path("plain") / "map.pgm"), read_file(path("a") / "map.pgm"));
  EXPECT_EQ(read_file(path("plain") / "trajectory.csv"), read_file(path("a") / "trajectory.csv"));
  ASSERT_EQ(map("b", {"--resume", path("s").string(), "--save-session", path("again").string()}).code, 0);
  expect_same_files("a", "b");
  ASSERT_EQ(map("c", {"--resume", path("again").string()}).code, 0);
  expect_same_files("a", "c");
}

TEST_F(PriorMapApp, the_map_of_another_building_is_left_out) {
  const std::string size = "120 70";
  std::string image = "P2\n" + size + "\n255\n";
  for (int y = 0; y < 70; ++y)
    for (int x = 0; x < 120; ++x)
      image += x % 30 == 3 || y % 33 == 3 || (x > 60 && y == 18) ? "0\n" : "254\n";
  write_file(path("other.pgm"), image);
  write_file(path("other.yaml"),
             "image: other.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
             "free_thresh: 0.196\n");
  const AppRun run = map("a", {log_.string(), "--set", "prior.map=" + path("other.yaml").string()});
  ASSERT_EQ(run.code, 0) << run.err;
  EXPECT_THAT(run.err, AllOf(HasSubstr("other.yaml: this map is left out, because the run does not fit it"),
                             HasSubstr("its own frame")));
  ASSERT_EQ(map("b", {log_.string()}).code, 0);
  expect_same_files("b", "a");
}

TEST_F(PriorMapApp, a_prior_map_is_extended_without_moving_its_walls) {
  const std::string prior = prior_map("crop polygon=-1,-1;9,-1;9,11;-1,11\n");
  ASSERT_EQ(map("a", {log_.string(), "--set", prior, "--set", "prior.extend=true"}).code, 0);
  EXPECT_LT(worst_m("a"), 0.06);
  const auto before = read_map_file(path("prior") / "map.yaml");
  const auto after = read_map_file(path("a") / "map.yaml");
  EXPECT_LT(before.getXMax(), 9.5F);
  EXPECT_GT(after.getXMax(), 11.9F);
  std::size_t known = 0;
  std::size_t new_walls = 0;
  for (int y = 0; y < static_cast<int>(after.getSizeY()); ++y) {
    for (int x = 0; x < static_cast<int>(after.getSizeX()); ++x) {
      const double x_m = static_cast<double>(after.idx2x(x));
      const double y_m = static_cast<double>(after.idx2y(y));
      const int old_x = before.x2idx(x_m);
      const int old_y = before.y2idx(y_m);
      // MRPT rounds coordinates less than a cell outside of a map into it.
      const bool is_inside =
          x_m > static_cast<double>(before.getXMin()) && y_m > static_cast<double>(before.getYMin());
      const float cell = is_inside ? before.getCell(old_x, old_y) : 0.5F;
      if (cell != 0.5F) {
        ++known;
        EXPECT_EQ(after.getCell(x, y), cell) << x_m << ' ' << y_m;
      } else if (x_m > 11.8 && y_m > 0.5 && y_m < 7.5 && after.getCell(x, y) < 0.3F) {
        EXPECT_NEAR(x_m, 12, 0.15);
        ++new_walls;
      }
    }
  }
  EXPECT_GT(known, 10'000U);
  EXPECT_GT(new_walls, 100U);
}

TEST_F(PriorMapApp, results_never_replace_the_prior_map) {
  const std::string prior = prior_map("");
  const std::string bytes = read_file(path("prior") / "map.pgm");
  const AppRun run = map("prior", {log_.string(), "--force", "--set", prior});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err,
              AllOf(HasSubstr("may replace it"), HasSubstr("Choose another folder for the results")));
  EXPECT_EQ(read_file(path("prior") / "map.pgm"), bytes);
}

TEST_F(PriorMapApp, a_map_far_from_the_origin_is_refused) {
  write_file(path("far.pgm"), "P2\n3 3\n255\n0 254 0\n254 254 254\n0 254 0\n");
  write_file(path("far.yaml"),
             "image: far.pgm\nresolution: 0.05\norigin: [450123.4, 5412345.6, 0]\nnegate: 0\n"
             "occupied_thresh: 0.65\nfree_thresh: 0.196\n");
  const AppRun run = map("a", {log_.string(), "--set", "prior.map=" + path("far.yaml").string()});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, AllOf(HasSubstr("far.yaml: the map reaches from x 450123."),
                             HasSubstr("expected at most 200 km from the origin")));
}

TEST_F(PriorMapApp, merged_runs_get_its_frame_too) {
  const std::string prior = prior_map("");
  write_lines(path("second.log"), room_log_lines(40, kScansOfRound));
  const auto merge = [&](const std::string& out, std::vector<std::string> inputs) {
    inputs.insert(inputs.begin(), "merge");
    inputs.insert(inputs.end(), {"-q", "-o", path(out).string()});
    const AppRun run = run_app(inputs);
    EXPECT_EQ(run.code, 0) << run.err;
    const Trajectory trajectory = read_trajectory(path(out) / "trajectory.tum");
    EXPECT_EQ(trajectory.size(), 100U);
    for (std::size_t i = 0; i < trajectory.size(); ++i) {
      const std::size_t scan = i < 60 ? i : i - 60;
      const mrpt::math::TPose2D truth = room_pose(2 * M_PI * static_cast<double>(scan) / kScansOfRound);
      EXPECT_LT(std::hypot(trajectory[i].pose.x - truth.x, trajectory[i].pose.y - truth.y), 0.06) << i;
    }
    return run.err;
  };
  const std::string second = path("second.log").string();
  merge("logs", {log_.string(), second, "--set", prior});
  merge("start", {log_.string(), second, "--set", prior, "--start", "10.2,4,90"});  // in the frame of the map
  // The sessions of both runs were made with the same prior map, which changes later.
  const auto session = [&](const std::string& name) { return path(name + ".session").string(); };
  ASSERT_EQ(map("1", {log_.string(), "--set", prior, "--save-session", session("1")}).code, 0);
  ASSERT_EQ(map("2", {second, "--set", prior, "--save-session", session("2")}).code, 0);
  EXPECT_THAT(merge("sessions", {session("1"), session("2")}), Not(HasSubstr("prior map")));
  expect_same_files("logs", "sessions");
  write_file(path("prior") / "map.yaml", read_file(path("prior") / "map.yaml") + "# moved\n");
  ASSERT_EQ(map("1b", {log_.string(), "--set", prior, "--save-session", session("1b")}).code, 0);
  EXPECT_THAT(merge("changed", {session("1b"), session("2")}),
              HasSubstr("this prior map has changed since the session was saved"));
}

TEST_F(PriorMapApp, contradicting_settings_and_edits_are_refused) {
  const std::string prior = prior_map("");
  const auto refused = [&](std::vector<std::string> more, const std::string& sentence) {
    more.insert(more.begin(), log_.string());
    const AppRun run = map("refused", std::move(more));
    EXPECT_EQ(run.code, 2) << sentence;
    EXPECT_THAT(run.err, HasSubstr(sentence));
  };
  refused({"--set", prior, "--set", "map.align=walls"},
          "prior.map states the frame of the map, but map.align");
  refused({"--set", prior, "--edits", path("prior.edits").string()},
          "and so do the lines pose and tag of the edits");
  refused({"--set", prior, "--set", "prior.layers=WALLS"},
          "prior.layers is for a drawing, but prior.map is ");
  refused({"--set", prior, "--set", "prior.metres_per_unit=0.001"}, "prior.metres_per_unit is for a drawing");
  refused({"--set", "prior.extend=true"}, "prior.extend needs a map to extend");
  refused({"--set", "prior.map=" + path("none.yaml").string()}, "none.yaml");
  refused({"--set", prior, "--set", "prior.extend=true", "--set", "map.resolution_m=0.1"},
          "Set map.resolution_m=0.05");
  const std::string yaml = read_file(path("prior") / "map.yaml");
  const std::size_t origin = yaml.find("origin: [");
  write_file(path("prior") / "shifted.yaml",
             yaml.substr(0, origin) + "origin: [-1.023, -1.5, 0]" + yaml.substr(yaml.find(']', origin) + 1));
  refused({"--set", "prior.map=" + (path("prior") / "shifted.yaml").string(), "--set", "prior.extend=true"},
          "its origin is no multiple of its resolution");
}

}  // namespace
}  // namespace psi_slam
