// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/zone_files.h"

#include <gmock/gmock.h>
#include <mrpt/containers/yaml.h>
#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/TPolygon2D.h>

#include <cmath>
#include <fstream>

#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Kind = MapEdit::Kind;

MapEdit zone(Kind kind, double x_min, double x_max, double percent = 0, double max_speed_mps = 0) {
  MapEdit edit;
  edit.kind = kind;
  edit.points = {{x_min, 0}, {x_max, 0}, {x_max, 1}, {x_min, 1}};
  edit.percent = percent;
  edit.max_speed_mps = max_speed_mps;
  return edit;
}

class ZoneFiles : public testing::Test {
 protected:
  void write(const std::vector<MapEdit>& edits) { write_zone_files(folder_.path(), grid_, edits); }
  bool exists(const char* name) const { return std::filesystem::exists(folder_.path() / name); }

  /// Value of a mask at a point, as nav2's map_server computes it in mode scale.
  int value(const std::string& name, double x_m, double y_m) const {
    const auto yaml = mrpt::containers::yaml::FromFile((folder_.path() / (name + ".yaml")).string());
    EXPECT_EQ(yaml["mode"].as<std::string>(), "scale");
    EXPECT_EQ(yaml["free_thresh"].as<double>(), 0);
    EXPECT_EQ(yaml["occupied_thresh"].as<double>(), 1);
    const std::string pgm = read_file(folder_.path() / (name + ".pgm"));
    const std::string pixels = pgm.substr(pgm.find("255\n") + 4);
    EXPECT_EQ(pixels.size(), grid_.getSizeX() * grid_.getSizeY());
    const auto row = grid_.getSizeY() - 1 - static_cast<std::size_t>(grid_.y2idx(y_m));
    const auto pixel = static_cast<unsigned char>(
        pixels[row * grid_.getSizeX() + static_cast<std::size_t>(grid_.x2idx(x_m))]);
    return static_cast<int>(std::rint((255 - pixel) / 255.0 * 100));
  }

  TemporaryFolder folder_;
  mrpt::maps::COccupancyGridMap2D grid_{-1, 9, -1, 2, 0.05F};
};

TEST_F(ZoneFiles, keep_out_zones_have_value_100) {
  write({zone(Kind::kKeepOut, 1, 2), zone(Kind::kErase, 4, 5)});
  EXPECT_EQ(value("keepout_mask", 1.5, 0.5), 100);
  EXPECT_EQ(value("keepout_mask", 1.5, 1.5), 0);
  EXPECT_EQ(value("keepout_mask", 4.5, 0.5), 0);
  EXPECT_FALSE(exists("speed_mask.yaml"));
}

TEST_F(ZoneFiles, nav2_computes_the_percentage_of_slow_zones) {
  std::vector<MapEdit> zones;
  for (const int percent : {1, 40, 99})
    zones.push_back(zone(Kind::kSlow, 0.08 * percent, 0.08 * percent + 0.5, percent));
  zones.push_back(zone(Kind::kSlow, 3.4, 3.7, 20));  // overlaps the zone of 40 %
  write(zones);
  EXPECT_THAT(read_file(folder_.path() / "speed_mask.yaml"),
              HasSubstr("type 1, base 100.0, multiplier -1.0\n"));
  const auto limit = [&](double x_m) { return 100 - value("speed_mask", x_m, 0.5); };
  EXPECT_EQ(limit(0.3), 1);
  EXPECT_EQ(limit(3.3), 40);
  EXPECT_EQ(limit(3.55), 20) << "the slower zone counts";
  EXPECT_EQ(limit(8.2), 99);
  EXPECT_EQ(value("speed_mask", 6, 0.5), 0) << "no limit";
}

TEST_F(ZoneFiles, nav2_computes_the_speed_of_slow_zones) {
  write({zone(Kind::kSlow, 0, 1, 0, 0.8), zone(Kind::kSlow, 0.5, 2, 0, 0.3)});
  EXPECT_THAT(read_file(folder_.path() / "speed_mask.yaml"),
              HasSubstr("type 2, base 0.0, multiplier 0.008\n"));
  EXPECT_NEAR(0.008 * value("speed_mask", 0.3, 0.5), 0.8, 1e-9);
  EXPECT_EQ(value("speed_mask", 0.8, 0.5), 37) << "0.296 m/s: rounded down";
}

TEST_F(ZoneFiles, percent_and_speed_cannot_be_mixed) {
  EXPECT_THAT(sentence_of([&] {
                write({zone(Kind::kSlow, 0, 1, 40), zone(Kind::kSlow, 2, 3, 0, 0.3)});
              }),
              HasSubstr("expected one of them"));
}

TEST_F(ZoneFiles, no_slow_zone_has_the_value_of_no_limit) {
  write({zone(Kind::kSlow, 0, 1, 0.5)});
  EXPECT_EQ(value("speed_mask", 0.5, 0.5), 99) << "nav2 reads 100 as no limit";
}

TEST_F(ZoneFiles, speeds_below_a_hundredth_of_the_fastest_are_refused) {
  const auto pair = [](double slow_mps) {
    return std::vector<MapEdit>{zone(Kind::kSlow, 0, 1, 0, 0.3), zone(Kind::kSlow, 2, 3, 0, slow_mps)};
  };
  EXPECT_THAT(sentence_of([&] { write(pair(0.0029)); }),
              HasSubstr("max_speed_mps=0.0029 of a slow zone is too small beside max_speed_mps=0.3"));
  write(pair(0.003));
  EXPECT_EQ(value("speed_mask", 2.5, 0.5), 1);
}

TEST_F(ZoneFiles, mrpt_reads_the_polygons) {
  write({zone(Kind::kKeepOut, 1, 2), zone(Kind::kSlow, 4, 6, 40)});
  mrpt::math::CMatrixDouble corners;
  corners.loadFromTextFile((folder_.path() / "zones.txt").string());
  ASSERT_EQ(corners.rows(), 8);
  ASSERT_EQ(corners.cols(), 5);
  mrpt::math::TPolygon2D slow;
  for (int row = 0; row < corners.rows(); ++row)
    if (corners(row, 0) == 2) slow.emplace_back(corners(row, 3), corners(row, 4));
  EXPECT_EQ(corners(4, 1), 1);
  EXPECT_EQ(corners(4, 2), 40);
  EXPECT_TRUE(slow.contains({5, 0.5}));
  EXPECT_FALSE(slow.contains({1.5, 0.5}));
}

TEST_F(ZoneFiles, without_zones_no_file_is_written) {
  write({zone(Kind::kErase, 4, 5)});
  for (const char* name :
       {"keepout_mask.yaml", "keepout_mask.pgm", "speed_mask.yaml", "speed_mask.pgm", "zones.txt"})
    EXPECT_FALSE(exists(name)) << name;
}

}  // namespace
}  // namespace psi_slam
