// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/map_files.h"

#include <gtest/gtest.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/maps/COccupancyGridMap2D.h>
#include <mrpt/obs/CObservation2DRangeScan.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDF.h>
#include <mrpt/serialization/CArchive.h>

#include <random>

#include "simulated_room.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

TEST(MrptMaps, mrpt_loads_the_simple_map_with_poses_scans_and_times) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.simplemap.gz";
  const MappingResult result = walk_around_the_room();
  write_mrpt_map(path, simple_map(result));
  mrpt::maps::CSimpleMap read;
  ASSERT_TRUE(read.loadFromFile(path.string()));
  ASSERT_EQ(read.size(), result.node_frames.size());
  for (std::size_t node = 0; node < read.size(); ++node) {
    const auto& keyframe = *(read.begin() + static_cast<std::ptrdiff_t>(node));
    const auto& frame = result.frames[result.node_frames[node]];
    EXPECT_NEAR(keyframe.pose->getMeanVal().x(), frame.map_T_robot.x, 1e-9);
    EXPECT_NEAR(keyframe.pose->getMeanVal().yaw(), frame.map_T_robot.phi, 1e-9);
    const auto scan = keyframe.sf->getObservationByClass<mrpt::obs::CObservation2DRangeScan>();
    ASSERT_TRUE(scan);
    EXPECT_EQ(scan->getScanSize(), 181U);
    EXPECT_NEAR(mrpt::Clock::toDouble(scan->timestamp), seconds(frame.time_us), 1e-6);
  }
}

TEST(MrptMaps, mrpt_loads_the_grid_cell_by_cell) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.gridmap.gz";
  mrpt::maps::COccupancyGridMap2D grid(-1.5F, 300, 4, 300, 0.25F);
  std::mt19937 random(1);
  for (unsigned y = 0; y < grid.getSizeY(); ++y)
    for (unsigned x = 0; x < grid.getSizeX(); ++x)
      grid.setCell(static_cast<int>(x), static_cast<int>(y), static_cast<float>(random() % 100) / 100);
  write_mrpt_map(path, grid);
  mrpt::io::CFileGZInputStream file(path.string());
  mrpt::maps::COccupancyGridMap2D read;
  mrpt::serialization::archiveFrom(file) >> read;
  EXPECT_EQ(read.getRawMap(), grid.getRawMap());
  EXPECT_EQ(read.getXMin(), grid.getXMin());
}

TEST(MrptMaps, equal_maps_give_equal_bytes_without_a_time_in_the_header) {
  const TemporaryFolder folder;
  const MappingResult result = walk_around_the_room();
  write_mrpt_map(folder.path() / "a.gz", simple_map(result));
  write_mrpt_map(folder.path() / "b.gz", simple_map(result));
  const std::string bytes = read_file(folder.path() / "a.gz");
  EXPECT_EQ(bytes, read_file(folder.path() / "b.gz"));
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x1f\x8b\x08\x00\x00\x00\x00\x00", 8));
}

}  // namespace
}  // namespace psi_slam
