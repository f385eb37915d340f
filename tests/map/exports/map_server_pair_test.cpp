// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/map_server_pair.h"

#include <gmock/gmock.h>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using ::testing::HasSubstr;

/// Map of 3 m x 2 m with its lower left corner at (-1.5, 4) m and cells of 0.25 m. The lower half is free,
/// the upper half unknown. The lower left corner of the only occupied cell is at (-0.5, 4.25) m.
COccupancyGridMap2D lopsided_map() {
  COccupancyGridMap2D grid(-1.5F, 1.5F, 4, 6, 0.25F);
  for (int x = 0; x < 12; ++x)
    for (int y = 0; y < 4; ++y) grid.setCell(x, y, 0.99F);
  grid.setCell(4, 1, 0.01F);
  return grid;
}

TEST(MapServerPair, image_has_row_0_on_top_and_three_values) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "map.yaml", lopsided_map());
  const std::string header = "P5\n12 8\n255\n";
  const std::string pgm = read_file(folder.path() / "map.pgm");
  ASSERT_EQ(pgm.substr(0, header.size()), header);
  ASSERT_EQ(pgm.size(), header.size() + 12 * 8);
  const auto pixel = [&](int column, int row) {
    return static_cast<int>(
        static_cast<unsigned char>(pgm[header.size() + static_cast<std::size_t>(row * 12 + column)]));
  };
  EXPECT_EQ(pixel(0, 0), 205) << "unknown on top";
  EXPECT_EQ(pixel(0, 7), 254) << "free at the bottom";
  EXPECT_EQ(pixel(4, 6), 0) << "the obstacle in the second row from below";
  EXPECT_EQ(std::count(pgm.begin() + static_cast<std::ptrdiff_t>(header.size()), pgm.end(), '\0'), 1);
}

TEST(MapServerPair, yaml_names_the_image_and_the_lower_left_corner) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "map.yaml", lopsided_map());
  EXPECT_EQ(read_file(folder.path() / "map.yaml"),
            "image: map.pgm\n"
            "resolution: 0.25\n"
            "origin: [-1.5, 4.0, 0.0]\n"
            "negate: 0\n"
            "occupied_thresh: 0.65\n"
            "free_thresh: 0.196\n"
            "mode: trinary\n");
}

TEST(MapServerPair, writes_lengths_without_trailing_zeros) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "map.yaml", COccupancyGridMap2D(-37.3F, 10, -1234.55F, 0, 0.05F));
  EXPECT_THAT(read_file(folder.path() / "map.yaml"),
              HasSubstr("resolution: 0.05\norigin: [-37.3, -1234.55, 0.0]\n"));
}

TEST(MapServerPair, quotes_names_with_yaml_characters) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "it's: a #1.yaml", lopsided_map());
  EXPECT_THAT(read_file(folder.path() / "it's: a #1.yaml"), HasSubstr("image: 'it''s: a #1.pgm'\n"));
}

TEST(MapServerPair, mrpt_loads_it_at_the_same_place) {
  const TemporaryFolder folder;
  const COccupancyGridMap2D written = lopsided_map();
  write_map_server_pair(folder.path() / "map.yaml", written);
  COccupancyGridMap2D read;
  ASSERT_TRUE(read.loadFromROSMapServerYAML((folder.path() / "map.yaml").string()));
  EXPECT_FLOAT_EQ(read.getXMin(), -1.5F);
  EXPECT_FLOAT_EQ(read.getYMin(), 4);
  EXPECT_FLOAT_EQ(read.getResolution(), 0.25F);
  ASSERT_EQ(read.getSizeX(), 12U);
  ASSERT_EQ(read.getSizeY(), 8U);
  EXPECT_LT(read.getPos(-0.4F, 4.3F), 0.35F) << "the obstacle";
  EXPECT_GT(read.getPos(-0.6F, 4.3F), 0.8F);
  EXPECT_GT(read.getPos(-0.4F, 4.6F), 0.8F);
}

TEST(MapServerPair, reports_a_missing_folder) {
  const TemporaryFolder folder;
  EXPECT_THROW(write_map_server_pair(folder.path() / "missing" / "map.yaml", lopsided_map()), SystemFailure);
}

}  // namespace
}  // namespace psi_slam
