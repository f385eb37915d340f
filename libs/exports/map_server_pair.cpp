// SPDX-License-Identifier: BSD-3-Clause
#include "exports/map_server_pair.h"

#include <algorithm>
#include <string>

#include "base/atomic_file.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr char kOccupied = '\0';
constexpr char kFree = static_cast<char>(254);
constexpr char kUnknown = static_cast<char>(205);
constexpr float kOccupiedThreshold = 0.65F;  // probability that the cell is occupied
constexpr float kFreeThreshold = 0.196F;

std::string pgm_bytes(const COccupancyGridMap2D& grid) {
  const std::size_t width = grid.getSizeX();
  const std::size_t height = grid.getSizeY();
  std::string bytes = "P5\n" + std::to_string(width) + ' ' + std::to_string(height) + "\n255\n";
  const std::size_t header = bytes.size();
  bytes.resize(header + width * height, kUnknown);
  for (std::size_t y = 0; y < height; ++y) {
    const auto* cells = grid.getRow(static_cast<int>(y));
    char* pixels = bytes.data() + header + (height - 1 - y) * width;
    std::transform(cells, cells + width, pixels, [](COccupancyGridMap2D::cellType cell) {
      const float occupied = 1 - COccupancyGridMap2D::l2p(cell);
      return occupied > kOccupiedThreshold ? kOccupied : occupied < kFreeThreshold ? kFree : kUnknown;
    });
  }
  return bytes;
}

/// MRPT stores lengths as floats, which resolve a tenth of a millimetre in a map of one kilometre.
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

std::string yaml_text(const std::string& image, const COccupancyGridMap2D& grid) {
  return "image: " + yaml_scalar(image) + "\nresolution: " + shortest_text(grid.getResolution()) +
         "\norigin: [" + metres(grid.getXMin()) + ", " + metres(grid.getYMin()) +
         ", 0.0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\nmode: trinary\n";
}

}  // namespace

void write_map_server_pair(const std::filesystem::path& yaml_path, const COccupancyGridMap2D& grid) {
  const std::filesystem::path pgm_path = std::filesystem::path(yaml_path).replace_extension(".pgm");
  write_text_atomically(pgm_path, pgm_bytes(grid));
  write_text_atomically(yaml_path, yaml_text(pgm_path.filename().string(), grid));
}

}  // namespace psi_slam
