// SPDX-License-Identifier: BSD-3-Clause
// Opens each map file with a program of another project and measures a room of 6 m x 4 m in it.
#include "map/exports/map_files.h"

#include <gmock/gmock.h>

#include <cmath>

#include "foreign_program.h"
#include "map/exports/mapped_trajectory.h"
#include "measured_room.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/user_error.h"
#include "simulated_room.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;

constexpr double kCell_m = 0.05;
/// Tolerance of one cell, because walls on the border of two cells may fall into either. 1 % is for rounding.
constexpr double kClose_m = 1.01 * kCell_m;

class MapFiles : public testing::Test {
 protected:
  MapFiles() : result_(walk_around_the_room()), grid_(draw_grid_map(result_.log, mapped_poses(result_))) {
    options_.png = options_.ros = options_.mrpt = options_.svg = options_.dxf = false;
  }

  std::filesystem::path write(const std::string& name) {
    WorkerPool(1).run(map_file_tasks(folder_.path(), result_, *grid_, {}, options_));
    return folder_.path() / name;
  }

  /// Runs the Python script that measures a map file. Returns its exit code and output.
  static ForeignRun measured(const std::filesystem::path& file) {
    return run_foreign("/usr/bin/python3 '" PSI_SLAM_MEASURE_MAP "' '" + file.string() + "'");
  }

  const TemporaryFolder folder_;
  const SimulatedRoom room_;
  const MappingResult result_;
  const mrpt::maps::COccupancyGridMap2D::Ptr grid_;
  MapFileOptions options_;
};

#define MEASURE_OR_SKIP(run, file)                         \
  const ForeignRun run = measured(file);                   \
  if (run.code == ForeignRun::kNotInstalled) GTEST_SKIP(); \
  ASSERT_EQ(run.code, 0) << run.out

TEST_F(MapFiles, cad_reader_finds_the_walls_in_place) {
  options_.dxf = true;
  MEASURE_OR_SKIP(run, write("map.dxf"));
  const std::vector<double> numbers = run.numbers();
  ASSERT_EQ(numbers.size(), 9U) << run.out;
  expect_room(numbers, room_, kClose_m);
  EXPECT_GE(numbers[4], 1) << "outlines on the layer WALLS";
  EXPECT_EQ(numbers[5], 1) << "one line on the layer TRAJECTORY";
  EXPECT_EQ(numbers[6], 0) << "errors that the reader's audit found or mended";
  EXPECT_EQ(numbers[7], 6) << "metres in $INSUNITS";
  EXPECT_EQ(numbers[8], 1) << "metric in $MEASUREMENT";
}

TEST_F(MapFiles, gdal_reads_the_drawing) {
  options_.dxf = true;
  const ForeignRun run = run_foreign("ogrinfo -al -so '" + write("map.dxf").string() + "' 2>&1");
  if (run.code == 127) GTEST_SKIP() << "gdal-bin is not installed";
  ASSERT_EQ(run.code, 0) << run.out;
  const std::size_t at = run.out.find("Extent: (");
  ASSERT_NE(at, std::string::npos) << run.out;
  double x_min = 0, y_min = 0, x_max = 0, y_max = 0;
  ASSERT_EQ(
      std::sscanf(run.out.c_str() + at, "Extent: (%lf, %lf) - (%lf, %lf)", &x_min, &y_min, &x_max, &y_max),
      4);
  EXPECT_NEAR(x_max - x_min, 6, kClose_m);
  EXPECT_NEAR(y_max - y_min, 4, kClose_m);
}

TEST_F(MapFiles, svg_is_true_to_scale) {
  options_.svg = true;
  MEASURE_OR_SKIP(run, write("map.svg"));
  const std::vector<double> numbers = run.numbers();
  ASSERT_EQ(numbers.size(), 7U) << run.out;
  expect_room(numbers, room_, 1.5 * kCell_m);  // lines extend half their width beyond the walls
  EXPECT_NEAR(numbers[4], 60 + 2 * 5, 2) << "millimetres of paper including margins of 5 mm";
  EXPECT_NEAR(numbers[5], numbers[4] * 10, 1) << "pixels at 254 dpi";
}

TEST_F(MapFiles, svg_follows_the_scale) {
  options_.svg = true;
  options_.print_scale = 50;
  EXPECT_THAT(read_file(write("map.svg")), HasSubstr("1:50"));
  MEASURE_OR_SKIP(run, write("map.svg"));
  EXPECT_NEAR(run.numbers().at(4), 120 + 2 * 5, 4);
}

TEST_F(MapFiles, geotiff_is_in_local_metres_by_default) {
  options_.geotiff = true;
  MEASURE_OR_SKIP(run, write("map.tif"));
  const std::vector<double> numbers = run.numbers();
  ASSERT_GE(numbers.size(), 4U) << run.out;
  expect_room(numbers, room_, kClose_m);
  EXPECT_THAT(run.out, EndsWith(" local metre 255.0\n"));
}

TEST_F(MapFiles, geotiff_follows_its_reference) {
  options_.geotiff = true;
  options_.earth = x_axis_to_the_north(25832);
  MEASURE_OR_SKIP(run, write("map.tif"));
  const std::vector<double> numbers = run.numbers();
  ASSERT_GE(numbers.size(), 4U) << run.out;
  expect_room_with_x_axis_to_the_north(numbers, room_, kClose_m);
  EXPECT_THAT(run.out, HasSubstr(" 25832 metre "));
}

TEST_F(MapFiles, writes_only_the_files_asked_for) {
  options_.dxf = true;
  write("map.dxf");
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder_.path()))
    names.push_back(entry.path().filename().string());
  EXPECT_THAT(names, ElementsAre("map.dxf"));
}

TEST_F(MapFiles, reports_a_missing_folder) {
  for (bool MapFileOptions::*wanted :
       {&MapFileOptions::svg, &MapFileOptions::dxf, &MapFileOptions::geotiff, &MapFileOptions::gpkg}) {
    MapFileOptions options = options_;
    options.*wanted = true;
    EXPECT_THROW(WorkerPool(1).run(map_file_tasks(folder_.path() / "missing", result_, *grid_, {}, options)),
                 SystemFailure);
  }
}

}  // namespace
}  // namespace psi_slam
