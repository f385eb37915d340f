// SPDX-License-Identifier: BSD-3-Clause
// Opens GeoPackages with GDAL's Python module, with its check of the specification, and with ogrinfo.
#include <gmock/gmock.h>

#include <cmath>
#include <thread>

#include "foreign_program.h"
#include "map/exports/map_files.h"
#include "map/exports/mapped_trajectory.h"
#include "measured_room.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/user_error.h"
#include "simulated_room.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using Kind = MapEdit::Kind;

class GeoPackage : public testing::Test {
 protected:
  GeoPackage()
      : result_(walk_around_the_room()),
        walls_(draw_map_lines(*draw_grid_map(result_.log, mapped_poses(result_)), {}).walls) {}

  static MapEdit zone(MapEdit::Kind kind, double percent = 0, double max_speed_mps = 0) {
    MapEdit edit;
    edit.kind = kind;
    edit.points = {{1, 0}, {2, 0}, {2, 3}};
    edit.percent = percent;
    edit.max_speed_mps = max_speed_mps;
    return edit;
  }

  /// Writes a GeoPackage of the room and returns its bytes.
  std::string write(const std::string& name = "map.gpkg") const {
    write_geo_package(folder_.path() / name, walls_, trajectories_of_runs(result_), edits_, earth_);
    return read_file(folder_.path() / name);
  }

  ForeignRun measured() const {
    return run_foreign("/usr/bin/python3 '" PSI_SLAM_MEASURE_MAP "' '" +
                       (folder_.path() / "map.gpkg").string() + "'");
  }

  /// The features of a layer as ogrinfo prints them.
  ForeignRun features(const std::string& layer) const {
    return run_foreign("ogrinfo -q '" + (folder_.path() / "map.gpkg").string() + "' " + layer + " 2>&1");
  }

  static constexpr double kClose_m = 1.01 * 0.05;  // a cell, because walls on a border fall into either cell

  const TemporaryFolder folder_;
  const SimulatedRoom room_;
  MappingResult result_;
  const std::vector<MapLine> walls_;
  std::vector<MapEdit> edits_;
  GeoReference earth_;
};

#define RUN_OR_SKIP(run, command)                               \
  const ForeignRun run = command;                               \
  if (run.code == ForeignRun::kNotInstalled || run.code == 127) \
    GTEST_SKIP() << "needs python3-gdal and gdal-bin";          \
  ASSERT_EQ(run.code, 0) << run.out

TEST_F(GeoPackage, is_valid_and_has_the_walls_in_local_metres) {
  edits_ = {zone(Kind::kKeepOut), zone(Kind::kSlow, 40)};
  write();
  RUN_OR_SKIP(run, measured());
  const std::vector<double> numbers = run.numbers();
  ASSERT_GE(numbers.size(), 4U) << run.out;
  EXPECT_NEAR(numbers[0], room_.x_min, kClose_m);
  EXPECT_NEAR(numbers[1], room_.x_max, kClose_m);
  EXPECT_NEAR(numbers[2], room_.y_min, kClose_m);
  EXPECT_NEAR(numbers[3], room_.y_max, kClose_m);
  EXPECT_THAT(run.out, EndsWith(" Undefined_Cartesian_SRS 1 walls:" + std::to_string(walls_.size()) +
                                " path:1 keep_out:1 slow:1\n"));
}

TEST_F(GeoPackage, follows_its_reference) {
  for (const int epsg : {25832, 31467}) {  // UTM, and a system whose first axis is the northing
    earth_ = x_axis_to_the_north(epsg);
    write();
    RUN_OR_SKIP(run, measured());
    const std::vector<double> numbers = run.numbers();
    ASSERT_GE(numbers.size(), 4U) << run.out;
    expect_room_with_x_axis_to_the_north(numbers, room_, kClose_m);
    EXPECT_THAT(run.out, HasSubstr(" " + std::to_string(epsg) + " 1 "));
  }
  earth_.epsg = 4326;
  EXPECT_THROW(write(), UserError);
}

TEST_F(GeoPackage, outlines_are_closed_and_thin_walls_are_single_lines) {
  write_geo_package(folder_.path() / "map.gpkg", {{{0, 0}, {1, 0}, {1, 1}}, {{2, 0}, {3, 0}}}, {}, {});
  RUN_OR_SKIP(run, features("walls"));
  EXPECT_THAT(run.out, HasSubstr("LINESTRING (0 0,1 0,1 1,0 0)\n"));
  EXPECT_THAT(run.out, HasSubstr("LINESTRING (2 0,3 0)\n"));
}

TEST_F(GeoPackage, path_has_the_time_of_each_pose_and_a_line_for_each_run) {
  result_ = walk_around_the_room(30);
  result_.frames.resize(5);
  for (std::size_t i = 0; i < 5; ++i) result_.frames[i].map_T_robot = {static_cast<double>(i) + 0.5, 0.5, 0};
  result_.later_run_frames = {2, 4};
  result_.frames[4].time_us = -1'500;  // a run of one pose, which is no line
  write();
  RUN_OR_SKIP(run, features("path"));
  EXPECT_THAT(run.out,
              AllOf(HasSubstr("run (Integer) = 1\n"), HasSubstr("run (Integer) = 2\n"),
                    Not(HasSubstr("run (Integer) = 3\n")),
                    HasSubstr("start (DateTime) = 2000/12/05 21:48:25.167+00\n"),
                    HasSubstr("end (DateTime) = 2000/12/05 21:48:25.367+00\n"),
                    HasSubstr("LINESTRING M (0.5 0.5 976052905.167303,1.5 0.5 976052905.367303)\n"),
                    HasSubstr("LINESTRING M (2.5 0.5 976052905.567303,3.5 0.5 976052905.767303)\n")));
  RUN_OR_SKIP(contents,
              run_foreign("ogrinfo -q -dialect SQLITE -sql 'SELECT last_change FROM gpkg_contents' '" +
                          (folder_.path() / "map.gpkg").string() + "'"));
  EXPECT_THAT(contents.out, HasSubstr("1969/12/31 23:59:59.998")) << "the time of the last pose";
}

TEST_F(GeoPackage, zones_have_their_limits) {
  edits_ = {zone(Kind::kErase), zone(Kind::kSlow, 40), zone(Kind::kKeepOut), zone(Kind::kSlow, 0, 0.3)};
  write();
  RUN_OR_SKIP(keep_out, features("keep_out"));
  EXPECT_THAT(keep_out.out,
              AllOf(HasSubstr("zone (Integer) = 2\n"), HasSubstr("POLYGON ((1 0,2 0,2 3,1 0))")));
  RUN_OR_SKIP(slow, features("slow"));
  EXPECT_THAT(
      slow.out,
      AllOf(HasSubstr("zone (Integer) = 1\n  percent (Real) = 40\n  max_speed_mps (Real) = (null)\n"),
            HasSubstr("zone (Integer) = 3\n  percent (Real) = (null)\n  max_speed_mps (Real) = 0.3\n")));
}

TEST_F(GeoPackage, has_all_layers_without_zones_and_poses) {
  result_.frames.clear();
  result_.log.clear();
  write();
  RUN_OR_SKIP(run, measured());
  EXPECT_THAT(run.out, EndsWith(" path:0 keep_out:0 slow:0\n"));
}

TEST_F(GeoPackage, equal_maps_give_equal_bytes_at_any_time) {
  edits_ = {zone(Kind::kKeepOut)};
  const std::string bytes = write("a.gpkg");
  EXPECT_EQ(bytes.substr(0, 15), "SQLite format 3");
  std::this_thread::sleep_for(std::chrono::milliseconds(5));  // the file states times in milliseconds
  EXPECT_EQ(write("b.gpkg"), bytes);
  result_.frames.back().time_us += 1000;
  EXPECT_NE(write("c.gpkg"), bytes);
}

TEST_F(GeoPackage, appears_whole_or_not_at_all) {
  const std::string bytes = write();
  earth_.epsg = 999'999;
  EXPECT_THROW(write(), UserError);
  EXPECT_EQ(read_file(folder_.path() / "map.gpkg"), bytes) << "the older file stays";
  const std::filesystem::directory_iterator files(folder_.path());
  EXPECT_EQ(std::distance(begin(files), end(files)), 1) << "no partial file";
  EXPECT_THROW(write_geo_package(folder_.path() / "missing" / "map.gpkg", walls_, {}, {}), SystemFailure);
}

}  // namespace
}  // namespace psi_slam
