// SPDX-License-Identifier: BSD-3-Clause
#include "exports/map_files.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <functional>
#include <memory>

#include "base/atomic_file.h"
#include "compression/compression.h"
#include "exports/map_server_pair.h"
#include "exports/mapped_trajectory.h"
#include "observations/mrpt_objects.h"
#include "rendering/map_image.h"

namespace psi_slam {

using mrpt::maps::COccupancyGridMap2D;

mrpt::maps::CSimpleMap simple_map(const MappingResult& result) {
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 1e-6);
  mrpt::maps::CSimpleMap map;
  for (const std::size_t frame : result.node_frames) {
    auto observations = mrpt::obs::CSensoryFrame::Create();
    for (const auto& observation : range_observations(result.log.at(frame)))
      observations->insert(observation);
    const mrpt::poses::CPosePDFGaussian pose(mrpt::poses::CPose2D(result.frames.at(frame).map_T_robot),
                                             covariance);
    map.insert(std::make_shared<mrpt::poses::CPose3DPDFGaussian>(pose), observations);
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
                     const COccupancyGridMap2D& grid, const std::vector<MapEdit>& edits,
                     const MapFileOptions& options) {
  using Write = std::function<void(const std::filesystem::path&)>;
  const auto file = [&](bool wanted, const char* name, const Write& write) {
    if (wanted) write(folder / name);
  };
  const auto text_file = [&](bool wanted, const char* name, const std::function<std::string()>& text) {
    file(wanted, name, [&](const auto& path) { write_text_atomically(path, text()); });
  };
  file(options.png, "map.png", [&](const auto& path) { write_map_image(path, grid); });
  file(options.ros, "map.yaml", [&](const auto& path) { write_map_server_pair(path, grid); });
  file(options.mrpt, "map.gridmap.gz", [&](const auto& path) { write_mrpt_map(path, grid); });
  file(options.mrpt, "map.simplemap.gz", [&](const auto& path) { write_mrpt_map(path, simple_map(result)); });
  MapDrawing drawing;
  if (options.svg || options.dxf || options.gpkg)
    drawing = draw_map_lines(grid, paths_of_runs(result), options.lines);
  text_file(options.svg, "map.svg", [&] { return map_svg(drawing, options.print_scale); });
  text_file(options.dxf, "map.dxf", [&] { return map_dxf(drawing); });
  text_file(options.print, "map_print.png", [&] { return print_map(grid, options); });
  file(options.geotiff, "map.tif", [&](const auto& path) { write_geo_tiff(path, grid, options.earth); });
  file(options.gpkg, "map.gpkg", [&](const auto& path) {
    write_geo_package(path, drawing.walls, trajectories_of_runs(result), edits, options.earth);
  });
}

}  // namespace psi_slam
