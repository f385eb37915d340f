// SPDX-License-Identifier: BSD-3-Clause
// Maps of other programs: a map.yaml beside an image.
#include "localization/map_server_file.h"

#include <gmock/gmock.h>
#include <zlib.h>

#include <cmath>
#include <opencv2/imgcodecs.hpp>
#include <string>

#include "localization/reference_map.h"
#include "map/exports/map_server_pair.h"
#include "shared_logs.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using testing::HasSubstr;

constexpr const char* kThresholds = "occupied_thresh: 0.65\nfree_thresh: 0.196\n";
constexpr int kColumns = 80;
constexpr int kRows = 60;
constexpr int kWall = 30;  // column
constexpr int kTop = 50;   // rows from here on are unknown

class ForeignMap : public testing::Test {
 protected:
  COccupancyGridMap2D read(const std::string& image, const std::string& origin, const std::string& lines = "",
                           const std::string& thresholds = kThresholds) {
    write_file(yaml_, "image: " + image + "\nresolution: 0.05\norigin: " + origin + "\nnegate: 0\n" +
                          thresholds + lines);
    return read_map_file(yaml_);
  }

  std::string sentence(const std::string& origin, const std::string& lines = "",
                       const std::string& thresholds = kThresholds) {
    return sentence_of([&] { read("map.pgm", origin, lines, thresholds); });
  }

  /// Writes a map with free space, a wall and unknown cells as map.pgm. Returns its pixels, top row first.
  cv::Mat write_map() {
    COccupancyGridMap2D grid(-1.5F, 2.5F, 4, 7, 0.05F);
    for (int y = 0; y < kTop; ++y)
      for (int x = 0; x < kColumns; ++x) grid.setCell(x, y, x == kWall ? 0.02F : 0.97F);
    write_map_server_pair(yaml_, grid);
    return cv::imread((folder_.path() / "map.pgm").string(), cv::IMREAD_UNCHANGED);
  }

  void write_image(const std::string& name, const cv::Mat& image) {
    cv::imwrite((folder_.path() / name).string(), image);
  }

  TemporaryFolder folder_;
  std::filesystem::path yaml_ = folder_.path() / "map.yaml";
};

TEST_F(ForeignMap, is_read_as_by_mrpt) {
  write_map();
  for (const char* origin :
       {"[-1.5, 4.0, 0.0]", "[-1.75, -7.55, 0]", "[0.013, 1000.02, 0]", "[33.3, -2.225, 0]"}) {
    const COccupancyGridMap2D grid = read("map.pgm", origin);
    COccupancyGridMap2D by_mrpt;
    ASSERT_TRUE(by_mrpt.loadFromROSMapServerYAML(yaml_.string()));
    EXPECT_EQ(grid.getXMin(), by_mrpt.getXMin()) << origin;
    EXPECT_EQ(grid.getYMin(), by_mrpt.getYMin()) << origin;
    EXPECT_EQ(grid.getXMax(), by_mrpt.getXMax()) << origin;
    EXPECT_EQ(grid.getSizeX(), by_mrpt.getSizeX()) << origin;
    EXPECT_EQ(grid.getSizeY(), by_mrpt.getSizeY()) << origin;
    EXPECT_TRUE(grid.getRawMap() == by_mrpt.getRawMap()) << origin;
  }
}

TEST_F(ForeignMap, may_have_black_for_free_space) {
  const cv::Mat image = write_map();
  const COccupancyGridMap2D expected = read("map.pgm", "[0, 0, 0]");
  cv::Mat negative = image.clone();
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x)
      negative.at<std::uint8_t>(y, x) = static_cast<std::uint8_t>(255 - image.at<std::uint8_t>(y, x));
  write_image("negative.png", negative);
  for (const auto& [negate, name] : {std::pair{"1", "negative.png"}, std::pair{"true", "negative.png"},
                                     std::pair{"0", "map.pgm"}, std::pair{"false", "map.pgm"}}) {
    read(name, "[0, 0, 0]");
    std::string yaml = read_file(yaml_);
    yaml.replace(yaml.find("negate: 0") + 8, 1, negate);
    write_file(yaml_, yaml);
    EXPECT_TRUE(read_map_file(yaml_).getRawMap() == expected.getRawMap()) << negate;
  }
}

TEST_F(ForeignMap, without_a_valid_yaw_is_not_turned) {
  write_map();
  const COccupancyGridMap2D expected = read("map.pgm", "[-1.5, 4.0, 0.0]");
  for (const char* origin : {"[-1.5, 4.0]", "[-1.5, 4.0, nan]", "[-1.5, 4.0, -nan]", "[-1.5, 4.0, .NaN]"}) {
    const COccupancyGridMap2D grid = read("map.pgm", origin);
    EXPECT_TRUE(grid.getRawMap() == expected.getRawMap()) << origin;
    EXPECT_EQ(grid.getXMin(), expected.getXMin()) << origin;
  }
}

TEST_F(ForeignMap, of_16_bits_or_with_opacity_has_the_same_cells) {
  const cv::Mat image = write_map();
  const COccupancyGridMap2D expected = read("map.pgm", "[-1.5, 4.0, 0.0]");
  cv::Mat wide;
  image.convertTo(wide, CV_16U, 257);
  write_image("wide.png", wide);
  write_image("wide.pgm", wide);
  std::string low = "P5\n" + std::to_string(image.cols) + ' ' + std::to_string(image.rows) + "\n100\n";
  cv::Mat clear(image.rows, image.cols, CV_8UC4);
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.cols; ++x) {
      const auto grey = image.at<std::uint8_t>(y, x);
      low += static_cast<char>(std::lround(grey / 2.55));
      const bool is_unknown = grey == 205;
      const std::uint8_t shown = is_unknown ? 0 : grey;  // transparent black
      clear.at<cv::Vec4b>(y, x) = {shown, shown, shown, static_cast<std::uint8_t>(is_unknown ? 0 : 255)};
    }
  write_file(folder_.path() / "low.pgm", low);
  write_image("clear.png", clear);
  cv::Mat wide_clear;
  clear.convertTo(wide_clear, CV_16U, 257);
  write_image("wide_clear.png", wide_clear);
  for (const char* name : {"wide.png", "wide.pgm", "low.pgm", "clear.png", "wide_clear.png"}) {
    EXPECT_TRUE(read(name, "[-1.5, 4.0, 0.0]").getRawMap() == expected.getRawMap()) << name;
    EXPECT_TRUE(read(name, "[-1.5, 4.0, 0]", "mode: trinary\n").getRawMap() == expected.getRawMap()) << name;
  }
  EXPECT_TRUE(read("clear.png", "[-1.5, 4.0, 0]", "mode: scale\n").getRawMap() == expected.getRawMap());
}

/// Writes a PNG image of grey and opacity, which OpenCV does not write. The rows begin with their filter, 0.
void write_grey_alpha_png(const std::filesystem::path& path, const cv::Mat& grey, std::uint8_t transparent) {
  const auto big_endian = [](std::size_t number) {
    std::string bytes;
    for (const int shift : {24, 16, 8, 0}) bytes += static_cast<char>(number >> shift);
    return bytes;
  };
  const auto chunk = [&](const std::string& kind_and_data) {
    const auto* bytes = reinterpret_cast<const Bytef*>(kind_and_data.data());
    return big_endian(kind_and_data.size() - 4) + kind_and_data +
           big_endian(crc32_z(0, bytes, kind_and_data.size()));
  };
  std::string rows;
  for (int y = 0; y < grey.rows; ++y) {
    rows += '\0';
    for (int x = 0; x < grey.cols; ++x) {
      const auto value = grey.at<std::uint8_t>(y, x);
      rows += static_cast<char>(value == transparent ? 0 : value);
      rows += static_cast<char>(value == transparent ? 0 : 255);
    }
  }
  uLongf size = compressBound(rows.size());
  std::string packed(size, '\0');
  compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(rows.data()),
           rows.size());
  packed.resize(size);
  const std::string form("\x08\x04\0\0\0", 5);  // 8 bits, grey and opacity
  write_file(path, "\x89PNG\r\n\x1A\n" +
                       chunk("IHDR" + big_endian(static_cast<std::size_t>(grey.cols)) +
                             big_endian(static_cast<std::size_t>(grey.rows)) + form) +
                       chunk("IDAT" + packed) + chunk("IEND"));
}

TEST_F(ForeignMap, of_grey_and_opacity_has_the_same_cells) {
  const cv::Mat image = write_map();
  const COccupancyGridMap2D expected = read("map.pgm", "[-1.5, 4.0, 0.0]");
  write_grey_alpha_png(folder_.path() / "grey_alpha.png", image, 205);
  EXPECT_TRUE(read("grey_alpha.png", "[-1.5, 4.0, 0.0]").getRawMap() == expected.getRawMap());
}

TEST(ForeignMaps, of_benchmark_logs_agree) {
  const auto path = shared_file("faults/maps/map2.yaml");
  if (!path) GTEST_SKIP() << kNeedsData;
  const COccupancyGridMap2D map = read_map_file(*path);
  EXPECT_NEAR(map.getXMin(), -1.75, 1e-6);
  EXPECT_NEAR(map.getYMin(), -7.55, 1e-6);
  for (const char* name : {"nanyaw.yaml", "rgbascale.yaml"}) {
    const COccupancyGridMap2D other = read_map_file(path->parent_path() / name);
    EXPECT_EQ(other.getXMin(), map.getXMin()) << name;
    EXPECT_TRUE(other.getRawMap() == map.getRawMap()) << name;
  }
  EXPECT_THAT(sentence_of([&] { read_map_file(path->parent_path() / "p16.yaml"); }),
              HasSubstr("p16.pgm does not exist"));
}

TEST_F(ForeignMap, of_scale_or_raw_has_cells_in_between) {
  cv::Mat image(1, 5, CV_8U);
  const int levels[] = {0, 100, 147, 190, 255};
  for (int x = 0; x < 5; ++x) image.at<std::uint8_t>(0, x) = static_cast<std::uint8_t>(levels[x]);
  write_image("map.png", image);
  const COccupancyGridMap2D grid = read("map.png", "[0, 0, 0]", "mode: scale\n");
  EXPECT_LT(grid.getCell(0, 0), 0.05F);
  for (int x = 1; x < 4; ++x)
    EXPECT_NEAR(grid.getCell(x, 0), 1 - ((255 - levels[x]) / 255.0 - 0.196) / (0.65 - 0.196), 0.02);
  EXPECT_GT(grid.getCell(4, 0), 0.95F);
  const COccupancyGridMap2D trinary = read("map.png", "[0, 0, 0]");
  for (int x = 1; x < 4; ++x) EXPECT_NEAR(trinary.getCell(x, 0), 0.5F, 0.01F);
  image.at<std::uint8_t>(0, 2) = 50;
  write_image("map.png", image);
  const COccupancyGridMap2D raw = read("map.png", "[0, 0, 0]", "mode: raw\n");
  EXPECT_GT(raw.getCell(0, 0), 0.95F);
  EXPECT_LT(raw.getCell(1, 0), 0.05F);
  EXPECT_NEAR(raw.getCell(2, 0), 0.5F, 0.01F);
  EXPECT_NEAR(raw.getCell(3, 0), 0.5F, 0.01F) << "above 100, so unknown";
}

TEST_F(ForeignMap, that_is_turned_has_its_cells_where_the_origin_says) {
  write_map();
  const COccupancyGridMap2D straight = read("map.pgm", "[0, 0, 0]");
  for (const double yaw_rad : {M_PI / 2, M_PI, -0.5, 0.1, 2.2}) {
    const COccupancyGridMap2D turned = read("map.pgm", "[-1.5, 4.0, " + std::to_string(yaw_rad) + "]");
    std::size_t walls = 0;
    for (int y = 1; y < kRows - 1; ++y)
      for (int x = 1; x < kColumns - 1; ++x) {
        const double right = 0.05 * (x + 0.5);
        const double up = 0.05 * (y + 0.5);
        const float cell =
            turned.getPos(static_cast<float>(-1.5 + right * std::cos(yaw_rad) - up * std::sin(yaw_rad)),
                          static_cast<float>(4 + right * std::sin(yaw_rad) + up * std::cos(yaw_rad)));
        if (straight.getCell(x, y) < 0.35F) {
          ++walls;
          EXPECT_LT(cell, 0.35F) << "yaw " << yaw_rad << ", cell " << x << ' ' << y;
        } else if (std::abs(x - kWall) > 1 && std::abs(y - kTop) > 2) {
          EXPECT_NEAR(cell, straight.getCell(x, y), 0.01F) << "yaw " << yaw_rad << ", cell " << x << ' ' << y;
        }
      }
    EXPECT_EQ(walls, 49U);
  }
}

TEST_F(ForeignMap, that_needs_countless_cells_when_turned_is_refused) {
  write_image("map.png", cv::Mat(1000, 50'000, CV_8U, cv::Scalar(254)));
  EXPECT_THAT(sentence_of([&] { read("map.png", "[0, 0, 0.785]"); }),
              HasSubstr("cells with the yaw of the key origin, expected at most 100000000 for a file"));
}

TEST_F(ForeignMap, that_the_decoder_refuses_is_refused_in_one_sentence) {
  write_file(folder_.path() / "map.pgm", "P5 1100000 50 255\n" + std::string(55'000'000, '\0'));
  EXPECT_THAT(sentence("[0, 0, 0]"),
              HasSubstr("map.pgm states 1100000 x 50 pixels, expected at most 1048576 along each side. Cut"));
  EXPECT_FALSE(grid_of_image(read_map_server_file(yaml_))) << "OpenCV throws an exception";
  write_file(folder_.path() / "map.bmp", "BM" + std::string(16, '\0') + std::string("\x4\0\0\0\x4\0\0\0", 8));
  EXPECT_THAT(sentence_of([&] { read("map.bmp", "[0, 0, 0]"); }),
              HasSubstr("is unreadable, expected an image"));
}

TEST_F(ForeignMap, with_thresholds_out_of_order_is_refused) {
  write_map();
  for (const char* thresholds :
       {"occupied_thresh: 0.5\nfree_thresh: 0.5\n", "occupied_thresh: 0.196\nfree_thresh: 0.65\n",
        "occupied_thresh: 65\nfree_thresh: 0.2\n", "occupied_thresh: 0.65\nfree_thresh: -0.1\n"})
    EXPECT_THAT(
        sentence("[0, 0, 0]", "mode: scale\n", thresholds),
        HasSubstr("map.yaml: the key occupied_thresh is invalid, expected a number above free_thresh, "
                  "and both from 0 to 1. Correct the file"))
        << thresholds;
}

TEST_F(ForeignMap, with_a_wrong_key_is_refused_with_its_name) {
  write_map();
  EXPECT_THAT(sentence("[nan, 0, 0]"),
              HasSubstr("map.yaml: the key origin is invalid, expected a list of two or three numbers"));
  for (const char* origin : {"[1]", "[1, 2, north]", "[1, 2, banana]", "5"})
    EXPECT_THAT(sentence(origin), HasSubstr("the key origin is invalid")) << origin;
  EXPECT_THAT(sentence("[0, 0, 0]", "mode: grey\n"),
              HasSubstr("the key mode is invalid, expected trinary, scale or raw. Correct the file"));
  EXPECT_THAT(sentence("[0, 0, 0]", "", "occupied_thresh: 0.65\n"),
              HasSubstr("map.yaml lacks the key free_thresh, expected a value"));
  EXPECT_THAT(sentence("[0, 0, 0]", "", "occupied_thresh: high\nfree_thresh: 0.1\n"),
              HasSubstr("the key occupied_thresh is invalid, expected a number"));
}

}  // namespace
}  // namespace psi_slam
