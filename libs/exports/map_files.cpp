// SPDX-License-Identifier: BSD-3-Clause
#include "exports/map_files.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <algorithm>
#include <functional>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "compression/compression.h"
#include "exports/mapped_trajectory.h"
#include "observations/mrpt_objects.h"
#include "rendering/map_image.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr char kOccupied = '\0';
constexpr char kFree = static_cast<char>(254);
constexpr char kUnknown = static_cast<char>(205);
constexpr float kOccupiedThreshold = 0.65F;  // cells with a larger probability are occupied
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

mrpt::maps::CSimpleMap simple_map(const MappingResult& result) {
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 1e-6);
  mrpt::maps::CSimpleMap map;
  for (const std::size_t frame : result.node_frames) {
    auto observations = mrpt::obs::CSensoryFrame::Create();
    for (const auto& observation : range_observations(result.log.at(frame)))
      observations->insert(observation);
    const mrpt::poses::CPose2D pose(result.frames.at(frame).map_T_robot);
    map.insert(mrpt::poses::CPosePDFGaussian::Create(pose, covariance), observations);
  }
  return map;
}

void write_mrpt_map(const std::filesystem::path& path, const mrpt::serialization::CSerializable& map) {
  constexpr std::size_t kGrowByBytes = 1 << 22;
  mrpt::io::CMemoryStream stream;
  stream.setAllocBlockSize(kGrowByBytes);
  auto archive = mrpt::serialization::archiveFrom(stream);
  archive << map;
  write_text_atomically(path, gzipped(stream.getRawBufferData(), stream.getTotalBytesCount()));
}

void write_map_files(const std::filesystem::path& folder, const MappingResult& result,
                     const COccupancyGridMap2D& grid, const MapFileOptions& options) {
  const auto remove = [&](const char* name) {
    std::error_code ignored;
    std::filesystem::remove(folder / name, ignored);
  };
  using Write = std::function<void(const std::filesystem::path&)>;
  const auto file = [&](bool wanted, const char* name, const Write& write) {
    wanted ? write(folder / name) : remove(name);
  };
  const auto text_file = [&](bool wanted, const char* name, const std::function<std::string()>& text) {
    file(wanted, name, [&](const auto& path) { write_text_atomically(path, text()); });
  };
  file(options.png, "map.png", [&](const auto& path) { write_map_image(path, grid); });
  file(options.ros, "map.yaml", [&](const auto& path) { write_map_server_pair(path, grid); });
  if (!options.ros) remove("map.pgm");
  file(options.mrpt, "map.gridmap.gz", [&](const auto& path) { write_mrpt_map(path, grid); });
  file(options.mrpt, "map.simplemap.gz", [&](const auto& path) { write_mrpt_map(path, simple_map(result)); });
  MapDrawing drawing;
  if (options.svg || options.dxf) drawing = draw_map_lines(grid, paths_of_runs(result), options.lines);
  text_file(options.svg, "map.svg", [&] { return map_svg(drawing, options.print_scale); });
  text_file(options.dxf, "map.dxf", [&] { return map_dxf(drawing); });
  text_file(options.print, "map_print.png", [&] { return print_map(grid, options); });
  file(options.geotiff, "map.tif", [&](const auto& path) { write_geo_tiff(path, grid, options.earth); });
}

}  // namespace psi_slam
