// SPDX-License-Identifier: BSD-3-Clause
#include "localization/reference_map.h"

#include <gmock/gmock.h>

#include "base/compression/compressed_file.h"
#include "base/file_checksum.h"
#include "decompression_bombs.h"
#include "map/exports/map_files.h"
#include "map/exports/map_server_pair.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;
using testing::HasSubstr;

/// Map with free space, one wall and unknown cells at the top. The lower left corner is at (-1.5, 4) m.
COccupancyGridMap2D small_map() {
  COccupancyGridMap2D grid(-1.5F, 2.5F, 4, 7, 0.05F);
  for (int y = 0; y < 50; ++y)
    for (int x = 0; x < 80; ++x) grid.setCell(x, y, x == 30 ? 0.02F : 0.97F);
  return grid;
}

TEST(MapFile, reads_both_formats_with_all_cells_in_place) {
  const TemporaryFolder folder;
  const COccupancyGridMap2D map = small_map();
  write_map_server_pair(folder.path() / "map.yaml", map);
  write_mrpt_map(folder.path() / "map.gridmap.gz", map);
  for (const char* name : {"map.yaml", "map.gridmap.gz"}) {
    const COccupancyGridMap2D read = read_map_file(folder.path() / name);
    ASSERT_EQ(read.getSizeX(), map.getSizeX()) << name;
    ASSERT_EQ(read.getSizeY(), map.getSizeY()) << name;
    EXPECT_NEAR(read.getXMin(), map.getXMin(), 1e-4) << name;
    EXPECT_NEAR(read.getYMin(), map.getYMin(), 1e-4) << name;
    EXPECT_LT(read.getCell(30, 10), 0.35F) << name;
    EXPECT_GT(read.getCell(31, 10), 0.65F) << name;
    EXPECT_NEAR(read.getCell(31, 55), 0.5F, 0.01F) << name << ": unknown cells stay unknown";
  }
}

TEST(MapFile, its_checksum_covers_the_image) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "map.yaml", small_map());
  write_mrpt_map(folder.path() / "map.gridmap.gz", small_map());
  const auto checksum = [&](const char* name) { return sha256_of_map_file(folder.path() / name); };
  EXPECT_EQ(checksum("map.gridmap.gz"), sha256_of_file(folder.path() / "map.gridmap.gz"));
  const std::string before = checksum("map.yaml");
  EXPECT_EQ(before, sha256_of_text(sha256_of_file(folder.path() / "map.yaml") + '\n' +
                                   sha256_of_file(folder.path() / "map.pgm") + '\n'));
  write_file(folder.path() / "map.pgm", read_file(folder.path() / "map.pgm") + ' ');
  EXPECT_NE(checksum("map.yaml"), before);
}

TEST(MapFile, rejects_files_that_are_no_map) {
  const TemporaryFolder folder;
  const auto sentence = [&](const std::string& name, const std::string& bytes) {
    write_file(folder.path() / name, bytes);
    return sentence_of([&] { read_map_file(folder.path() / name); });
  };
  EXPECT_THAT(sentence_of([&] { read_map_file(folder.path() / "none.yaml"); }), HasSubstr("none.yaml"));
  EXPECT_THAT(sentence("map.png", "x"), HasSubstr("expected map.yaml or map.gridmap.gz"));
  EXPECT_THAT(sentence("words.yaml", "image: [1"), HasSubstr("words.yaml"));
  EXPECT_THAT(sentence("torn.gridmap.gz", "no gridmap"), HasSubstr("is not a complete gridmap"));
  write_map_server_pair(folder.path() / "empty.yaml", COccupancyGridMap2D(0, 1, 0, 1, 0.05F));
  EXPECT_THAT(sentence_of([&] { read_map_file(folder.path() / "empty.yaml"); }),
              HasSubstr("the map has no wall"));
  write_map_server_pair(folder.path() / "map.yaml", small_map());
  std::filesystem::remove(folder.path() / "map.pgm");
  EXPECT_THAT(sentence_of([&] { read_map_file(folder.path() / "map.yaml"); }),
              HasSubstr("map.pgm does not exist, expected the image of the map"));
}

TEST(MapFile, rejects_cells_without_size) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "map.yaml", small_map());
  const std::string yaml = read_file(folder.path() / "map.yaml");
  const auto sentence = [&](const std::string& key, const std::string& value) {
    std::string changed = yaml;
    const std::size_t begin = changed.find(key) + key.size();
    changed.replace(begin, changed.find_first_of(",\n", begin) - begin, value);
    write_file(folder.path() / "other.yaml", changed);
    return sentence_of([&] { read_map_file(folder.path() / "other.yaml"); });
  };
  for (const char* value : {"0.00001", "0", "-0.05", "2"})
    EXPECT_THAT(sentence("resolution: ", value), HasSubstr("expected 0.001 to 1 m")) << value;
}

TEST(MapFile, tells_damaged_images_and_far_origins_in_one_sentence) {
  const TemporaryFolder folder;
  write_map_server_pair(folder.path() / "map.yaml", small_map());
  const std::string image = read_file(folder.path() / "map.pgm");
  const auto sentence_with = [&](const std::string& bytes) {
    write_file(folder.path() / "map.pgm", bytes);
    testing::internal::CaptureStderr();
    const std::string sentence = sentence_of([&] { read_map_file(folder.path() / "map.yaml"); });
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
    return sentence;
  };
  for (const std::string& bytes : {image.substr(0, image.size() / 2), std::string("P2 4 4 255\n1 2 3")})
    EXPECT_THAT(sentence_with(bytes), HasSubstr("map.pgm is cut off or damaged, expected an image of"));
  EXPECT_THAT(sentence_with("P5 0 0 255\n"),
              HasSubstr("map.pgm states 0 x 0 pixels, expected at least one. Export the map again"));
  std::string yaml = read_file(folder.path() / "map.yaml");
  yaml.replace(yaml.find("[-1.5"), 5, "[1e300");
  write_file(folder.path() / "map.yaml", yaml);
  EXPECT_THAT(sentence_with(image),
              HasSubstr("map.yaml: the map reaches from x 1e+300 m, y 4.0 m to x 1e+300 m, y"));
}

TEST(MapFile, checks_the_cell_counts_of_a_gridmap) {
  const TemporaryFolder folder;
  const auto path = folder.path() / "map.gridmap.gz";
  write_mrpt_map(path, small_map());
  std::string whole;
  CompressedFile file(path);
  for (char byte = 0; file.read(&byte, 1) == 1;) whole += byte;
  // Byte offset of the cell counts. The version and the bits per cell precede them.
  const std::size_t counts = whole.find("Map2D") + 7;
  const auto sentence_with = [&](std::size_t at, char byte) {
    std::string bytes = whole;
    bytes.at(counts + at) = byte;
    write_file(path, bytes);
    return sentence_of([&] { read_map_file(path); });
  };
  EXPECT_THAT(sentence_with(2, 0x40), HasSubstr("is damaged: it claims 4194384 x 60 cells"));
  EXPECT_THAT(sentence_with(27, 0x10), HasSubstr("expected 0.001 to 1 m"));
  EXPECT_THAT(sentence_with(15, 0x70), HasSubstr("is damaged: it claims"));
  write_file(path, whole.substr(0, whole.size() / 2));
  EXPECT_THAT(sentence_of([&] { read_map_file(path); }), HasSubstr("is damaged: it claims"));
}

TEST(MapFile, refuses_small_files_of_countless_cells) {
  const TemporaryFolder folder;
  expect_little_memory([&] {
    write_mrpt_map(folder.path() / "map.gridmap.gz", small_map());
    write_gzipped_zeros(folder.path() / "map.gridmap.gz", "", 2'000'000'000);
    EXPECT_THAT(sentence_of([&] { read_map_file(folder.path() / "map.gridmap.gz"); }),
                HasSubstr("which no map of its size has. Export the map with a coarser resolution"));
  });
  write_map_server_pair(folder.path() / "map.yaml", small_map());
  const auto sentence_with = [&](const std::string& image) {
    write_file(folder.path() / "map.pgm", image);
    return sentence_of([&] { read_map_file(folder.path() / "map.yaml"); });
  };
  expect_little_memory([&] {
    EXPECT_THAT(sentence_with("P5 30000 30000 255\n"),
                HasSubstr("map.pgm states 30000 x 30000 pixels, expected at most 100000000 for a file"));
    EXPECT_THAT(sentence_with("GIF89a"), HasSubstr("map.pgm is not an image that is read, expected PNG"));
    EXPECT_THAT(sentence_with("P5 9000 11000 255\n"), HasSubstr("map.pgm is cut off or damaged"));
  });
}

}  // namespace
}  // namespace psi_slam
