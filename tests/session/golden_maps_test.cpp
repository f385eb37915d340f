// SPDX-License-Identifier: BSD-3-Clause
// Maps real recordings with default settings and compares the maps with golden maps: maps of the same
// recordings that a person has judged to be right. golden_maps/README.md says how to make them again.
#include <gmock/gmock.h>
#include <mrpt/img/CImage.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "localization/reference_map.h"
#include "map/exports/map_files.h"
#include "map/exports/map_server_pair.h"
#include "map/exports/mapped_trajectory.h"
#include "map/exports/run_summary.h"
#include "psi_slam/configuration.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/mapping_session.h"
#include "shared_logs.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;
using mrpt::math::TPose2D;

/// A finished map of a recording.
struct Mapped {
  Grid::Ptr grid;
  Trajectory trajectory;
  double path_m = 0;
};

Mapped map_of(const std::filesystem::path& bag, const Configuration& configuration) {
  MappingSession session(bag, configuration);
  session.run(std::atomic<bool>(false));
  const MappingResult& result = session.result();
  Mapped mapped;
  mapped.grid = draw_grid_map(result.log, mapped_poses(result), configuration);
  mapped.trajectory = trajectory_of(result.frames);
  for (const auto& path : paths_of_runs(result)) mapped.path_m += path_length_m(path);
  return mapped;
}

bool is_wall(const Grid& map, int x, int y) {
  const bool is_inside =
      x >= 0 && y >= 0 && x < static_cast<int>(map.getSizeX()) && y < static_cast<int>(map.getSizeY());
  return is_inside && map.getRow(y)[x] < 0;
}

/// Returns the share of the occupied cells of `map` that have an occupied cell of `other` at most two cells
/// away. Both maps have the same frame and resolution.
double share_found_in(const Grid& other, const Grid& map) {
  constexpr int kReach = 2;
  int walls = 0;
  int found = 0;
  for (int y = 0; y < static_cast<int>(map.getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(map.getSizeX()); ++x) {
      if (!is_wall(map, x, y)) continue;
      ++walls;
      const int other_x = other.x2idx(map.idx2x(x));
      const int other_y = other.y2idx(map.idx2y(y));
      bool is_found = false;
      for (int j = -kReach; j <= kReach; ++j)
        for (int i = -kReach; i <= kReach; ++i)
          is_found = is_found || is_wall(other, other_x + i, other_y + j);
      found += is_found ? 1 : 0;
    }
  return walls == 0 ? 0 : static_cast<double>(found) / walls;
}

/// Writes NAME.yaml, and the map as NAME.png: a fraction of the size of the PGM file that map_server reads
/// too.
void write_golden_map(const std::filesystem::path& yaml_path, const Grid& map) {
  write_map_server_pair(yaml_path, map);
  std::filesystem::path image = yaml_path;
  image.replace_extension(".pgm");
  mrpt::img::CImage pixels;
  ASSERT_TRUE(pixels.loadFromFile(image.string(), 0));
  std::filesystem::remove(image);
  ASSERT_TRUE(pixels.saveToFile(image.replace_extension(".png").string()));
  std::string yaml = read_file(yaml_path);
  yaml.replace(yaml.find(".pgm"), 4, ".png");
  write_file(yaml_path, yaml);
}

struct GoldenBag {
  std::string name;
  double path_m;  ///< length of the path when the golden map was made
  friend void PrintTo(const GoldenBag& recording, std::ostream* out) { *out << recording.name; }
};

// In jan17_expt04, somebody carries the robot 6 m back to its start while odometry stands still. The path is
// therefore longer than that of the odometry, 16 m.
class GoldenMaps : public testing::TestWithParam<GoldenBag> {};

TEST_P(GoldenMaps, a_recording_gives_its_golden_map) {
  const auto bag = shared_file("bags/" + GetParam().name + ".bag");
  if (!bag) GTEST_SKIP() << kNeedsData;
  const Mapped mapped = map_of(*bag, {});
  RecordProperty("path_m", std::to_string(mapped.path_m));
  const auto golden_file = std::filesystem::path(PSI_SLAM_GOLDEN_MAPS) / (GetParam().name + ".yaml");
  if (std::getenv("PSI_SLAM_MAKE_GOLDEN_MAPS") != nullptr) {
    write_golden_map(golden_file, *mapped.grid);
    GTEST_SKIP() << "wrote " << golden_file << "; the path is " << mapped.path_m << " m long";
  }
  const Grid golden = read_map_file(golden_file);
  ASSERT_NEAR(golden.getResolution(), mapped.grid->getResolution(), 1e-6F);
  EXPECT_GT(share_found_in(*mapped.grid, golden), 0.9) << "walls of the golden map are missing";
  EXPECT_GT(share_found_in(golden, *mapped.grid), 0.9) << "walls are new or double";
  EXPECT_NEAR(mapped.path_m, GetParam().path_m, 0.05 * GetParam().path_m);
}

INSTANTIATE_TEST_SUITE_P(Real, GoldenMaps,
                         testing::Values(GoldenBag{"ccny_urg_demo", 4.3},
                                         GoldenBag{"guardian_controller_2", 21.4},
                                         GoldenBag{"jan17_expt04", 24.2}, GoldenBag{"jan17_expt10", 16.9},
                                         GoldenBag{"jarvis_circular_path_fast", 11.2}),
                         [](const auto& recording) { return recording.param.name; });

TEST(GoldenMapsComparison, tells_a_double_wall_from_a_single_one) {
  Grid single(0, 5, 0, 5, 0.05F);
  for (int y = 0; y < 100; ++y) single.setCell(20, y, 0.02F);
  Grid twice = single;
  for (int y = 0; y < 100; ++y) twice.setCell(24, y, 0.02F);
  EXPECT_EQ(share_found_in(twice, single), 1);
  EXPECT_EQ(share_found_in(single, twice), 0.5);
}

// ---- Comparison with ground truth ----

/// Root mean square distance in metres of two sets of points after the rigid motion that makes it smallest
/// (Umeyama, 1991, without scale).
double aligned_rmse_m(const std::vector<std::pair<TPose2D, TPose2D>>& pairs) {
  const auto n = static_cast<double>(pairs.size());
  double ax = 0, ay = 0, bx = 0, by = 0;
  for (const auto& [a, b] : pairs) ax += a.x / n, ay += a.y / n, bx += b.x / n, by += b.y / n;
  double along = 0, across = 0, squares = 0;
  for (const auto& [a, b] : pairs) {
    along += (a.x - ax) * (b.x - bx) + (a.y - ay) * (b.y - by);
    across += (a.x - ax) * (b.y - by) - (a.y - ay) * (b.x - bx);
    squares += std::pow(a.x - ax, 2) + std::pow(a.y - ay, 2) + std::pow(b.x - bx, 2) + std::pow(b.y - by, 2);
  }
  // The best rotation turns the sum of products into its length, so the squared distances sum to this:
  return std::sqrt(std::max(0.0, squares - 2 * std::hypot(along, across)) / n);
}

TEST(AlignedRmse, ignores_rigid_motions_and_measures_the_rest) {
  const TPose2D b_T_a(3, -2, 2.1);
  std::vector<std::pair<TPose2D, TPose2D>> pairs;
  for (const TPose2D& a : {TPose2D(0, 0, 0), TPose2D(4, 0, 0), TPose2D(4, 2, 0), TPose2D(0, 2, 0)})
    pairs.emplace_back(a, b_T_a + a);
  EXPECT_NEAR(aligned_rmse_m(pairs), 0, 1e-6);
  for (auto& [a, b] : pairs) b = b_T_a + TPose2D(1.1 * a.x, a.y, 0);  // 4.0 m became 4.4 m: 0.2 m at each end
  EXPECT_NEAR(aligned_rmse_m(pairs), 0.2, 1e-6);
}

/// Error of the mapped positions against ground truth, metres. The clock of the ground truth is shifted by up
/// to 0.3 s, to the smallest error.
double error_m(const Trajectory& mapped, const Trajectory& truth) {
  constexpr TimeUs kMostShift_us = 300'000;
  constexpr TimeUs kStep_us = 5'000;
  constexpr TimeUs kMaxGap_us = 1'000'000;
  double least_m = std::numeric_limits<double>::infinity();
  for (TimeUs shift_us = -kMostShift_us; shift_us <= kMostShift_us; shift_us += kStep_us) {
    std::vector<std::pair<TPose2D, TPose2D>> pairs;
    for (const StampedPose& pose : mapped)
      if (const auto there = pose_at_time(truth, pose.time_us + shift_us, kMaxGap_us))
        pairs.emplace_back(pose.pose, there->pose);
    if (2 * pairs.size() > mapped.size()) least_m = std::min(least_m, aligned_rmse_m(pairs));
  }
  return least_m;
}

/// The recording has ground truth from reflectors, and its clock is late by about 0.135 s. The ground truth
/// scatters by 9 mm (root mean square) about a smooth path through it, which no map can follow.
class JarvisGroundTruth : public testing::Test {
 protected:
  /// Returns the error in metres of the map with these settings, or nothing without the recording.
  std::optional<double> error_with(const Configuration& configuration) {
    const auto bag = shared_file("bags/jarvis_circular_path_fast.bag");
    const auto truth = shared_file("bags/jarvis_circular_path_fast.gt.tum");
    if (!bag || !truth) return std::nullopt;
    const double error = error_m(map_of(*bag, configuration).trajectory, read_trajectory(*truth));
    RecordProperty("rmse_m", std::to_string(error));
    return error;
  }
};

TEST_F(JarvisGroundTruth, with_one_laser) {
  Configuration configuration;
  configuration.set("log.scan_topic", "/driver_laser_navigation/laser_scan");
  const auto error_m = error_with(configuration);
  if (!error_m) GTEST_SKIP() << kNeedsData;
  EXPECT_LT(*error_m, 0.0135);
}

TEST_F(JarvisGroundTruth, with_both_lasers) {
  const auto error_m = error_with({});
  if (!error_m) GTEST_SKIP() << kNeedsData;
  EXPECT_LT(*error_m, 0.0155);
}

TEST_F(JarvisGroundTruth, with_both_lasers_and_their_delays) {
  Configuration configuration;
  configuration.set("log.calibrate", "true");
  const auto error_m = error_with(configuration);
  if (!error_m) GTEST_SKIP() << kNeedsData;
  EXPECT_LT(*error_m, 0.0125);
}

}  // namespace
}  // namespace psi_slam
