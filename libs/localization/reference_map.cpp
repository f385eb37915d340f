// SPDX-License-Identifier: BSD-3-Clause
#include "localization/reference_map.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/byte_cursor.h"
#include "base/compression/compressed_file.h"
#include "base/file_bytes.h"
#include "base/file_checksum.h"
#include "base/number_text.h"
#include "localization/image_size.h"
#include "localization/map_server_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;

// Merges cells into larger cells, which take the value of the most occupied cell. A larger cell is unknown
// only if all cells in it are unknown.
Grid in_larger_cells(const Grid& map, int factor) {
  const float resolution = map.getResolution() * static_cast<float>(factor);
  Grid larger;
  larger.setSize(map.getXMin() - resolution, map.getXMax() + resolution, map.getYMin() - resolution,
                 map.getYMax() + resolution, resolution, 0.5F);
  for (int y = 0; y < static_cast<int>(map.getSizeY()); ++y) {
    const Grid::cellType* row = map.getRow(y);
    Grid::cellType* larger_row = larger.getRow(larger.y2idx(map.idx2y(y)));
    for (int x = 0; x < static_cast<int>(map.getSizeX()); ++x) {
      Grid::cellType& cell = larger_row[larger.x2idx(map.idx2x(x))];
      cell = cell == 0 ? row[x] : row[x] == 0 ? cell : std::min(cell, row[x]);
    }
  }
  return larger;
}

constexpr const char* kExpected = "a map: map.yaml or map.gridmap.gz";

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

bool is_yaml_file(const std::filesystem::path& path) {
  return path.extension() == ".yaml" || path.extension() == ".yml";
}

constexpr double kLeastResolution_m = 0.001;
constexpr double kMostResolution_m = 1;
constexpr double kFarthest_m = 200'000;
constexpr double kLeastOffset = 0.01;  // of a cell; less is rounding

// A map has at most this number of cells, or this number per byte of its file, so that a small file cannot
// take all memory.
constexpr std::uint64_t kMostCellsOfAnyFile = 100'000'000;
constexpr std::uint64_t kMostCellsPerByte = 64;

std::uint64_t most_cells(const std::filesystem::path& file) {
  std::error_code error;
  const std::uint64_t bytes = std::filesystem::file_size(file, error);
  return error ? kMostCellsOfAnyFile : std::max(kMostCellsOfAnyFile, kMostCellsPerByte * bytes);
}

void check_resolution(const std::filesystem::path& path, double resolution_m) {
  if (!(resolution_m >= kLeastResolution_m && resolution_m <= kMostResolution_m))
    throw UserError(
        path.string() + ": resolution is " + shortest_text(static_cast<float>(resolution_m)) +
        " m, expected 0.001 to 1 m. Export the map again with psi-slam, or correct the resolution");
}

/// Throws UserError if a map of this size has more cells than most_cells() of `file`.
void check_cells(const std::filesystem::path& file, double width, double height, const std::string& unit) {
  const std::uint64_t most = most_cells(file);
  if (width * height > static_cast<double>(most))
    throw UserError(file.string() + " states " + fixed_text(width, 0) + " x " + fixed_text(height, 0) + ' ' +
                    unit + ", expected at most " + std::to_string(most) +
                    " for a file of its size. Export the map with a coarser resolution");
}

/// Returns the size of `file`. Throws UserError if `file`, the image that `map.yaml` names, does not exist or
/// is damaged, which OpenCV reports on the terminal only, or if its header states no pixels or more than
/// most_cells().
ImageSize check_image(const std::filesystem::path& path, const std::filesystem::path& file) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(file, ignored))
    throw UserError(
        path.string() + ": the image " + file.string() +
        " does not exist, expected the image of the map. Copy the image, or correct the key image");
  constexpr std::size_t kHeadBytes = std::size_t{1} << 20;
  std::string head(kHeadBytes, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream.bad()) throw UserError("cannot read " + file.string() + ". Check its permissions and the disk");
  const std::optional<ImageSize> size = image_size(head);
  if (!size)
    throw UserError(file.string() +
                    " is not an image that is read, expected PNG, PGM, BMP or JPEG. Convert the image");
  check_cells(file, static_cast<double>(size->width), static_cast<double>(size->height), "pixels");
  if (size->width == 0 || size->height == 0)
    throw UserError(file.string() + " states " + std::to_string(size->width) + " x " +
                    std::to_string(size->height) + " pixels, expected at least one. Export the map again");
  constexpr std::uint64_t kMostOfSide = std::uint64_t{1} << 20;  // OpenCV refuses larger images
  if (std::max(size->width, size->height) > kMostOfSide)
    throw UserError(file.string() + " states " + std::to_string(size->width) + " x " +
                    std::to_string(size->height) + " pixels, expected at most " +
                    std::to_string(kMostOfSide) + " along each side. Cut the map");
  if (!holds_all_pixels(file_bytes(file)))
    throw UserError(file.string() + " is cut off or damaged, expected an image of " +
                    std::to_string(size->width) + " x " + std::to_string(size->height) +
                    " pixels. Copy or export the map again");
  return *size;
}

PlacedMapFile read_yaml(const std::filesystem::path& path) {
  CompressedFile readable(path, kExpected);  // throws UserError for an unreadable file
  const MapServerFile file = read_map_server_file(path);
  check_resolution(path, file.resolution_m);
  const ImageSize size = check_image(path, file.image);
  const mrpt::math::TPose2D& origin = file.map_T_image;
  const auto& [low, high] = corners_of_grid(file, size);
  check_map_place(path, low, high);  // MRPT fails if both ends of the map are the same number of 32 bits
  check_cells(file.image, (high.x - low.x) / file.resolution_m, (high.y - low.y) / file.resolution_m,
              "cells with the yaw of the key origin");
  std::optional<Grid> grid = grid_of_image(file);
  if (!grid)
    throw UserError(path.string() +
                    ": the image that it names is unreadable, expected an image file such as map.pgm. "
                    "Export the map again with psi-slam");
  PlacedMapFile map{*std::move(grid)};
  if (origin.phi != 0) return map;  // its cells are where the origin says
  const auto offset = [&](double stated_m, float read_m) {
    const double off_m = stated_m - static_cast<double>(read_m);
    return std::abs(off_m) > kLeastOffset * file.resolution_m ? off_m : 0;
  };
  map.offset = {offset(origin.x, map.grid.getXMin()), offset(origin.y, map.grid.getYMin())};
  return map;
}

/// Reads a file with one byte per cell. Throws UserError if it has more bytes than most_cells().
std::vector<char> all_bytes(const std::filesystem::path& path) {
  CompressedFile file(path, kExpected);
  const std::uint64_t most = most_cells(path);
  std::vector<char> bytes;
  constexpr std::size_t kBlock = std::size_t{1} << 20;
  std::size_t read = kBlock;
  while (read > 0) {
    bytes.resize(bytes.size() + kBlock);
    read = file.read(bytes.data() + bytes.size() - kBlock, kBlock);
    bytes.resize(bytes.size() - kBlock + read);
    if (bytes.size() > most + kBlock)
      throw UserError(path.string() + " decompresses to more than " + std::to_string(most) +
                      " cells, which no map of its size has. Export the map with a coarser resolution");
  }
  return bytes;
}

/// Checks the header of a gridmap, because MRPT allocates a grid of any size that the header states. Throws
/// UserError if the size is implausible, and MalformedBytes if the bytes end within the header.
void check_gridmap(const std::filesystem::path& path, std::string_view bytes) {
  constexpr std::uint8_t kLengthOfName = 0x7F;
  ByteCursor cursor(bytes);
  cursor.take(cursor.number<std::uint8_t>() & kLengthOfName);
  // Skips the version number and, from version 2 on, the number of bits per cell.
  if (cursor.number<std::uint8_t>() >= 2) cursor.number<std::uint8_t>();
  const auto metres = [&] { return static_cast<double>(cursor.number<float>()); };
  const double cells_x = cursor.number<std::uint32_t>();
  const double cells_y = cursor.number<std::uint32_t>();
  const double x_min_m = metres();
  const double x_max_m = metres();
  const double y_min_m = metres();
  const double y_max_m = metres();
  const double resolution_m = metres();
  check_resolution(path, resolution_m);
  const auto agree = [&](double cells, double from_m, double to_m) {
    return std::abs(cells - (to_m - from_m) / resolution_m) <= 1.5;
  };
  if (!agree(cells_x, x_min_m, x_max_m) || !agree(cells_y, y_min_m, y_max_m) ||
      cells_x * cells_y > static_cast<double>(cursor.left()))
    throw UserError(path.string() + " is damaged: it claims " + fixed_text(cells_x, 0) + " x " +
                    fixed_text(cells_y, 0) + " cells, which contradicts its limits or its " +
                    std::to_string(bytes.size()) + " bytes. Copy or export the map again");
}

Grid read_gridmap(const std::filesystem::path& path) {
  const std::vector<char> bytes = all_bytes(path);
  mrpt::io::CMemoryStream stream;
  stream.assignMemoryNotOwn(bytes.data(), bytes.size());
  Grid grid;
  try {
    check_gridmap(path, {bytes.data(), bytes.size()});
    mrpt::serialization::archiveFrom(stream) >> grid;
  } catch (const UserError&) {
    throw;
  } catch (const std::exception&) {
    throw UserError(path.string() + " is not a complete gridmap of MRPT. Copy or export the map again");
  }
  return grid;
}

}  // namespace

ReferenceMap make_reference_map(const Grid& map, double search_resolution_m, double smoothing_sigma_m) {
  const auto resolution_m = static_cast<double>(map.getResolution());
  const int factor = std::max(1, static_cast<int>(std::floor(search_resolution_m / resolution_m + 1e-3)));
  LocalMapOptions options;
  options.smoothing_sigma_m = smoothing_sigma_m;
  ReferenceMap reference;
  reference.fine = std::make_shared<const LocalMap>(options, map);
  options.smoothing_sigma_m = smoothing_sigma_m * factor;
  reference.coarse = std::make_shared<const LocalMap>(options, in_larger_cells(map, factor));
  return reference;
}

void check_map_place(const std::filesystem::path& path, const mrpt::math::TPoint2D& low,
                     const mrpt::math::TPoint2D& high) {
  const double farthest_m = std::max({std::abs(low.x), std::abs(low.y), std::abs(high.x), std::abs(high.y)});
  if (farthest_m <= kFarthest_m) return;
  const auto text = [](double metres) {
    constexpr double kMostReadable_m = 1e9;
    return std::abs(metres) < kMostReadable_m ? fixed_text(metres, 1) : exact_text(metres);
  };
  throw UserError(
      path.string() + ": the map reaches from x " + text(low.x) + " m, y " + text(low.y) + " m to x " +
      text(high.x) + " m, y " + text(high.y) +
      " m, expected at most 200 km from the origin, because coordinates of grid maps have 32 bits. "
      "Subtract a constant from its coordinates");
}

PlacedMapFile read_placed_map_file(const std::filesystem::path& path) {
  const std::string name = path.filename().string();
  const bool is_yaml = is_yaml_file(path);
  if (!is_yaml && !ends_with(name, ".gridmap.gz") && !ends_with(name, ".gridmap"))
    throw UserError(path.string() +
                    " is not a map: expected map.yaml or map.gridmap.gz, as psi-slam writes them. Name one "
                    "of these files");
  PlacedMapFile map = is_yaml ? read_yaml(path) : PlacedMapFile{read_gridmap(path)};
  const auto corner = [](float x, float y) {
    return mrpt::math::TPoint2D(static_cast<double>(x), static_cast<double>(y));
  };
  check_map_place(path, corner(map.grid.getXMin(), map.grid.getYMin()),
                  corner(map.grid.getXMax(), map.grid.getYMax()));
  const auto& cells = map.grid.getRawMap();
  if (std::none_of(cells.begin(), cells.end(), [](Grid::cellType cell) { return cell < 0; }))
    throw UserError(path.string() +
                    ": the map has no wall, expected at least one occupied cell. Use a map with walls");
  return map;
}

std::string sha256_of_map_file(const std::filesystem::path& path) {
  if (!is_yaml_file(path)) return sha256_of_file(path);
  return sha256_of_text(sha256_of_file(path) + '\n' + sha256_of_file(read_map_server_file(path).image) +
                        '\n');
}

Grid read_map_file(const std::filesystem::path& path) {
  return read_placed_map_file(path).grid;
}

}  // namespace psi_slam
