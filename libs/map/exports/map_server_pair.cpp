// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/map_server_pair.h"

#include <algorithm>
#include <cmath>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "base/partial_files.h"
#include "map/rendering/map_image.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr char kOccupied = '\0';
constexpr char kFree = static_cast<char>(254);
constexpr char kUnknown = static_cast<char>(205);
constexpr const char* kTrinary = "occupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n";
constexpr const char* kScale = "occupied_thresh: 1.0\nfree_thresh: 0.0\nmode: scale\n";

/// Returns a binary PGM image, with row 0 of the grid at the bottom. `pixels_of(y)` returns row y.
template <class PixelsOf>
std::string pgm_bytes(const COccupancyGridMap2D& grid, const PixelsOf& pixels_of) {
  const std::size_t width = grid.getSizeX();
  const std::size_t height = grid.getSizeY();
  std::string bytes = "P5\n" + std::to_string(width) + ' ' + std::to_string(height) + "\n255\n";
  for (std::size_t y = height; y-- > 0;) bytes += pixels_of(y);
  return bytes;
}

std::string trinary_row(const COccupancyGridMap2D& grid, std::size_t y) {
  const auto* cells = grid.getRow(static_cast<int>(y));
  std::string pixels(grid.getSizeX(), kUnknown);
  std::transform(cells, cells + pixels.size(), pixels.begin(), [](COccupancyGridMap2D::cellType cell) {
    return is_occupied(cell) ? kOccupied : is_free(cell) ? kFree : kUnknown;
  });
  return pixels;
}

/// Text of a length in metres with up to four decimals. MRPT stores lengths as floats, which resolve 0.1 mm
/// in a map of 1 km.
std::string metres(float length) {
  const std::string text = trimmed_text(static_cast<double>(length), 4);
  return text.find('.') == std::string::npos ? text + ".0" : text;
}

/// Quotes the text unless it is certain to be a plain YAML scalar.
std::string yaml_scalar(const std::string& text) {
  constexpr const char* kPlain = "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-.";
  if (text.find_first_not_of(kPlain) == std::string::npos && text[0] != '-') return text;
  std::string quoted = "'";
  for (const char c : text) quoted += c == '\'' ? "''" : std::string(1, c);
  return quoted + '\'';
}

std::string yaml_text(const std::string& image, const COccupancyGridMap2D& grid, const std::string& values) {
  return "image: " + yaml_scalar(image) + "\nresolution: " + shortest_text(grid.getResolution()) +
         "\norigin: [" + metres(grid.getXMin()) + ", " + metres(grid.getYMin()) + ", 0.0]\nnegate: 0\n" +
         values;
}

/// Writes both files before either of them replaces an older one. Replaces the image first, so the pair is
/// complete once the YAML file exists.
void write_pair(const std::filesystem::path& yaml_path, const std::string& pgm,
                const COccupancyGridMap2D& grid, const std::string& comment, const std::string& values) {
  const std::filesystem::path pgm_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
  AtomicFile image(pgm_path);
  AtomicFile yaml(yaml_path);
  image.write(pgm);
  yaml.write(comment + yaml_text(pgm_path.filename().string(), grid, values));
  wait_for_disk(yaml.descriptor(), yaml_path);
  image.move_into_place();
  yaml.move_into_place();
}

}  // namespace

void write_map_server_pair(const std::filesystem::path& yaml_path, const COccupancyGridMap2D& grid) {
  write_pair(yaml_path, pgm_bytes(grid, [&](std::size_t y) { return trinary_row(grid, y); }), grid, "",
             kTrinary);
}

void write_mask_pair(const std::filesystem::path& yaml_path, const COccupancyGridMap2D& grid,
                     const std::vector<std::uint8_t>& values, const std::string& comment) {
  const std::size_t width = grid.getSizeX();
  const auto row = [&](std::size_t y) {
    std::string pixels(width, '\0');
    const auto first = values.begin() + static_cast<std::ptrdiff_t>(y * width);
    std::transform(first, first + static_cast<std::ptrdiff_t>(width), pixels.begin(), [](std::uint8_t value) {
      return static_cast<char>(static_cast<unsigned char>(std::lround(255 - 2.55 * value)));
    });
    return pixels;
  };
  write_pair(yaml_path, pgm_bytes(grid, row), grid, comment, kScale);
}

}  // namespace psi_slam
