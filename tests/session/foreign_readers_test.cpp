// SPDX-License-Identifier: BSD-3-Clause
// Opens the files of one real run as other programs do: evo, GTSAM, g2o, nav2, MRPT and geographic
// information systems, and compares what they read with the result of the session.
#include <gmock/gmock.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/math/wrap2pi.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "foreign_program.h"
#include "map/rendering/map_image.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/mapping_session.h"
#include "session/drawn_map.h"
#include "session/edit_journal.h"
#include "session/plan_drawing.h"
#include "session/settings.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using Numbers = std::vector<double>;

constexpr const char* kRealLog =
    "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
constexpr double kSlowPercent = 40;
/// Zones, a mark that is seen once, and positions without heading of the first and the last scan.
constexpr const char* kEdits =
    "keep_out polygon=-1,-1;-0.5,-1;-0.5,1;-1,1\n"
    "slow polygon=1,-1;2,-1;2,1;1,1 percent=40\n"
    "tag name=A x_m=1.5 y_m=0.2 sigma_m=0.02\n"
    "seen name=A time_s=1137834225.713386 ahead_m=1.5 left_m=0.2 sigma_m=0.03\n"
    "pose time_s=1137834225.713386 x_m=0 y_m=0 sigma_m=0.02\n"
    "pose time_s=1137834284.788331 x_m=4.22 y_m=-18.49 sigma_m=0.05\n";

/// A run, and what it exported.
struct ExportedRun {
  TemporaryFolder folder;
  MappingResult result;
  COccupancyGridMap2D::Ptr grid;

  ExportedRun() {
    Settings settings;
    settings.map_files.gpkg = true;
    MappingSession session(kRealLog, settings);
    session.add_edits(EditJournal::parse(kEdits, "my.edits"));
    while (session.step()) {
    }
    session.finish();
    session.export_to(folder.path(), true);
    session.read_exported([&](const MappingResult& exported) { result = exported; });
    grid = session.draw().grid;
  }
};

class ForeignReaders : public testing::Test {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(kRealLog))
      GTEST_SKIP() << "needs the rawlogs of Debian's package mrpt-common";
    if (!run_) run_ = std::make_unique<ExportedRun>();
  }
  static void TearDownTestSuite() { run_.reset(); }

  static std::string file(const std::string& name) { return (run_->folder.path() / name).string(); }

  /// Runs a command. Fails the test with its output unless it ends well or a program is missing.
  static ForeignRun output_of(const std::string& command) {
    const ForeignRun run = run_foreign(command);
    EXPECT_TRUE(run.code == 0 || run.code == ForeignRun::kNotInstalled) << command << ": " << run.out;
    return run;
  }
  static ForeignRun read_as(const std::string& program, const std::string& name) {
    return output_of("/usr/bin/python3 '" PSI_SLAM_FOREIGN_READERS "' " + program + " '" + file(name) + "'");
  }

  static void evo_reads_the_trajectory();
  static void gtsam_reads_the_graph();
  static void g2o_reads_the_graph_with_its_fixed_pose();
  static void nav2_reads_the_map();
  static void nav2_applies_the_zones();
  static void mrpt_loads_the_maps();
  static void drawings_have_the_walls_in_metres();

  static inline std::unique_ptr<ExportedRun> run_;
};

Numbers numbers_of(const std::string& text) {
  std::istringstream words(text);
  Numbers numbers;
  for (double number = 0; words >> number;) numbers.push_back(number);
  return numbers;
}

void ForeignReaders::evo_reads_the_trajectory() {
  std::istringstream lines(read_as("evo", "trajectory.tum").out);
  std::string line;
  for (const FrameRecord& frame : run_->result.frames) {
    ASSERT_TRUE(std::getline(lines, line));
    EXPECT_EQ(line.substr(0, line.find(' ')), format_seconds(frame.time_us));
    const Numbers numbers = numbers_of(line);
    ASSERT_EQ(numbers.size(), 4U) << line;
    EXPECT_NEAR(numbers[1], frame.map_T_robot.x, 1e-9);
    EXPECT_NEAR(numbers[2], frame.map_T_robot.y, 1e-9);
    EXPECT_NEAR(mrpt::math::wrapToPi(numbers[3] - frame.map_T_robot.phi), 0, 1e-9);
  }
  EXPECT_FALSE(std::getline(lines, line)) << line;
}

/// A pose graph as a program prints it: see foreign_readers.py.
struct ReadGraph {
  std::vector<Numbers> poses;
  std::vector<Numbers> edges;
  std::vector<Numbers> fixed;
  double chi2 = -1;

  explicit ReadGraph(const std::string& text) {
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
      const std::string kind = line.substr(0, line.find(' '));
      const Numbers numbers = numbers_of(line.substr(kind.size()));
      if (kind == "chi2")
        chi2 = numbers.at(0);
      else
        (kind == "pose" ? poses : kind == "edge" ? edges : fixed).push_back(numbers);
    }
    for (auto* list : {&poses, &edges}) std::sort(list->begin(), list->end());
  }
};

/// Expects that a program reads the graph that the session has, with the frame of the known positions as
/// root.
void expect_graph(const MappingResult& result, const ReadGraph& read) {
  const PoseGraph& graph = result.graph;
  ASSERT_GT(graph.num_nodes(), result.node_frames.size());
  ASSERT_EQ(read.poses.size(), graph.num_nodes());
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    const auto& pose = graph.pose(node);
    EXPECT_EQ(read.poses[node].at(0), static_cast<double>(node));
    EXPECT_NEAR(read.poses[node].at(1), pose.x, 1e-9);
    EXPECT_NEAR(read.poses[node].at(2), pose.y, 1e-9);
    EXPECT_NEAR(mrpt::math::wrapToPi(read.poses[node].at(3) - pose.phi), 0, 1e-9);
  }
  std::vector<Numbers> edges;
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    const Constraint& edge = graph.constraint(i);
    if (graph.enabled(i))
      edges.push_back({static_cast<double>(edge.from), static_cast<double>(edge.to), edge.from_T_to.x,
                       edge.from_T_to.y, edge.from_T_to.phi});
  }
  std::sort(edges.begin(), edges.end());
  ASSERT_EQ(read.edges.size(), edges.size());
  for (std::size_t i = 0; i < edges.size(); ++i) {
    ASSERT_EQ(read.edges[i].size(), 11U);
    for (std::size_t k = 0; k < edges[i].size(); ++k) EXPECT_NEAR(read.edges[i][k], edges[i][k], 1e-9) << i;
  }
  // The sum depends on each entry of each information matrix, and on the axes in which the program reads it.
  EXPECT_NEAR(read.chi2, graph.chi2(), 1e-6 * graph.chi2());
}

void ForeignReaders::gtsam_reads_the_graph() {
  expect_graph(run_->result, ReadGraph(read_as("gtsam", "graph.g2o").out));
}

void ForeignReaders::g2o_reads_the_graph_with_its_fixed_pose() {
#ifdef PSI_SLAM_READ_WITH_G2O
  const ReadGraph read(output_of("'" PSI_SLAM_READ_WITH_G2O "' '" + file("graph.g2o") + "'").out);
#else
  const ReadGraph read(read_as("g2o", "graph.g2o").out);
#endif
  expect_graph(run_->result, read);
  EXPECT_THAT(read.fixed, testing::ElementsAre(Numbers{static_cast<double>(run_->result.graph.root())}));
}

/// Values of cells as nav2's map_server publishes them, row by row from the lower left.
struct ReadCells {
  std::size_t width = 0;
  std::vector<int> values;
  Numbers header;

  explicit ReadCells(const std::string& text) {
    std::istringstream lines(text);
    std::string line;
    std::getline(lines, line);
    header = numbers_of(line);
    if (header.size() != 6) throw std::runtime_error("no header: " + line);
    width = static_cast<std::size_t>(header[0]);
    while (std::getline(lines, line)) {
      const Numbers runs = numbers_of(line);
      for (std::size_t i = 0; i + 1 < runs.size(); i += 2)
        values.insert(values.end(), static_cast<std::size_t>(runs[i + 1]), static_cast<int>(runs[i]));
    }
  }

  int at(const COccupancyGridMap2D& grid, double x_m, double y_m) const {
    return values.at(static_cast<std::size_t>(grid.y2idx(y_m)) * width +
                     static_cast<std::size_t>(grid.x2idx(x_m)));
  }

  /// Expects the place and the cells of the grid.
  void expect_layout(const COccupancyGridMap2D& grid) const {
    EXPECT_EQ(header[0], grid.getSizeX());
    EXPECT_EQ(header[1], grid.getSizeY());
    EXPECT_NEAR(header[2], static_cast<double>(grid.getResolution()), 1e-8);
    EXPECT_NEAR(header[3], static_cast<double>(grid.getXMin()), 1e-4);
    EXPECT_NEAR(header[4], static_cast<double>(grid.getYMin()), 1e-4);
    EXPECT_EQ(header[5], 0) << "yaw";
    EXPECT_EQ(values.size(), grid.getSizeX() * grid.getSizeY());
  }
};

#define CELLS_OR_SKIP(cells, name)                                                           \
  const ForeignRun run_of_##cells = read_as("nav2", name);                                   \
  if (run_of_##cells.code == ForeignRun::kNotInstalled) GTEST_SKIP() << "needs python3-pil"; \
  const ReadCells cells(run_of_##cells.out)

void ForeignReaders::nav2_reads_the_map() {
  CELLS_OR_SKIP(read, "map.yaml");
  const COccupancyGridMap2D& grid = *run_->grid;
  read.expect_layout(grid);
  const auto& cells = grid.getRawMap();
  std::size_t others = 0;
  for (std::size_t i = 0; i < cells.size(); ++i)
    others += read.values.at(i) != (is_occupied(cells[i]) ? 100 : is_free(cells[i]) ? 0 : -1) ? 1 : 0;
  EXPECT_EQ(others, 0U) << "cells that differ, of " << cells.size();
  EXPECT_GT(std::count(read.values.begin(), read.values.end(), 100), 1000);
}

void ForeignReaders::nav2_applies_the_zones() {
  CELLS_OR_SKIP(keep_out, "keepout_mask.yaml");
  CELLS_OR_SKIP(speed, "speed_mask.yaml");
  const COccupancyGridMap2D& grid = *run_->grid;
  keep_out.expect_layout(grid);
  speed.expect_layout(grid);
  EXPECT_EQ(keep_out.at(grid, -0.75, 0), 100);
  EXPECT_EQ(keep_out.at(grid, 0, 0), 0);
  // The filter computes base + multiplier * value, and takes the value 0 for no limit.
  std::istringstream lines(read_file(file("speed_mask.yaml")));
  std::string comment;
  std::getline(lines, comment);
  int type = 0;
  double base = 0, multiplier = 0;
  ASSERT_EQ(
      std::sscanf(comment.c_str(), "# costmap_filter_info_server of nav2: type %d, base %lf, multiplier %lf",
                  &type, &base, &multiplier),
      3)
      << comment;
  EXPECT_EQ(type, 1) << "percent of the largest speed";
  EXPECT_NEAR(base + multiplier * speed.at(grid, 1.5, 0), kSlowPercent, 1e-9);
  EXPECT_EQ(speed.at(grid, 0, 0), 0);
}

void ForeignReaders::mrpt_loads_the_maps() {
  const COccupancyGridMap2D& grid = *run_->grid;
  mrpt::io::CFileGZInputStream stream(file("map.gridmap.gz"));
  COccupancyGridMap2D map;
  mrpt::serialization::archiveFrom(stream) >> map;
  EXPECT_EQ(map.getRawMap(), grid.getRawMap());
  EXPECT_EQ(map.getXMin(), grid.getXMin());
  EXPECT_EQ(map.getYMin(), grid.getYMin());
  EXPECT_EQ(map.getResolution(), grid.getResolution());

  COccupancyGridMap2D of_ros;
  ASSERT_TRUE(of_ros.loadFromROSMapServerYAML(file("map.yaml")));
  ASSERT_EQ(of_ros.getSizeX(), grid.getSizeX());
  ASSERT_EQ(of_ros.getSizeY(), grid.getSizeY());
  EXPECT_NEAR(of_ros.getXMin(), grid.getXMin(), 1e-4);
  EXPECT_NEAR(of_ros.getYMin(), grid.getYMin(), 1e-4);
  std::size_t others = 0;
  for (std::size_t i = 0; i < grid.getRawMap().size(); ++i)
    others += is_occupied(of_ros.getRawMap()[i]) != is_occupied(grid.getRawMap()[i]) ? 1 : 0;
  EXPECT_EQ(others, 0U) << "cells that are occupied in one map only";

  mrpt::maps::CSimpleMap simple;
  ASSERT_TRUE(simple.loadFromFile(file("map.simplemap.gz")));
  ASSERT_EQ(simple.size(), run_->result.node_frames.size());
  for (std::size_t node = 0; node < simple.size(); ++node) {
    const auto& keyframe = *(simple.begin() + static_cast<std::ptrdiff_t>(node));
    const auto& pose = run_->result.frames[run_->result.node_frames[node]].map_T_robot;
    EXPECT_NEAR(keyframe.pose->getMeanVal().x(), pose.x, 1e-9);
    EXPECT_NEAR(keyframe.pose->getMeanVal().y(), pose.y, 1e-9);
    EXPECT_NEAR(mrpt::math::wrapToPi(keyframe.pose->getMeanVal().yaw() - pose.phi), 0, 1e-9);
  }
}

void ForeignReaders::drawings_have_the_walls_in_metres() {
  Numbers of_formats[2];
  for (int i = 0; i < 2; ++i) {
    const ForeignRun run = output_of("/usr/bin/python3 '" PSI_SLAM_MEASURE_MAP "' '" +
                                     file(i == 0 ? "map.dxf" : "map.gpkg") + "'");
    if (run.code == ForeignRun::kNotInstalled) GTEST_SKIP() << "needs python3-ezdxf and python3-gdal";
    of_formats[i] = run.numbers();
    ASSERT_GE(of_formats[i].size(), 4U) << run.out;
  }
  EXPECT_GT(of_formats[0][1] - of_formats[0][0], 10);
  for (std::size_t k = 0; k < 4; ++k) EXPECT_NEAR(of_formats[0][k], of_formats[1][k], 1e-4);
  // A drawing that states its unit is a floor plan as it is, with a margin around it.
  constexpr double kMargin_m = 1;
  const COccupancyGridMap2D plan = read_plan_drawing(file("map.dxf"), {}).grid;
  EXPECT_NEAR(static_cast<double>(plan.getXMin()), of_formats[0][0] - kMargin_m, 0.1);
  EXPECT_NEAR(static_cast<double>(plan.getYMax()), of_formats[0][3] + kMargin_m, 0.1);
}

TEST_F(ForeignReaders, read_the_trajectory_and_the_graph) {
  evo_reads_the_trajectory();
  gtsam_reads_the_graph();
  g2o_reads_the_graph_with_its_fixed_pose();
}

TEST_F(ForeignReaders, read_the_maps) {
  nav2_reads_the_map();
  nav2_applies_the_zones();
  mrpt_loads_the_maps();
  drawings_have_the_walls_in_metres();
}

}  // namespace
}  // namespace psi_slam
