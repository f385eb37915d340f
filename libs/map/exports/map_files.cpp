// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/map_files.h"

#include <mrpt/io/CMemoryStream.h>
#include <mrpt/obs/CSensoryFrame.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <memory>

#include "base/atomic_file.h"
#include "base/compression/compression.h"
#include "logs/frames/discarded_ranges.h"
#include "logs/observations/mrpt_objects.h"
#include "map/exports/map_server_pair.h"
#include "map/exports/mapped_trajectory.h"
#include "map/rendering/map_image.h"

namespace psi_slam {

using mrpt::maps::COccupancyGridMap2D;

mrpt::maps::CSimpleMap simple_map(const MappingResult& result) {
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 1e-6);
  mrpt::maps::CSimpleMap map;
  for (const std::size_t frame : result.node_frames) {
    if (!has_ranges(result.log.at(frame))) continue;
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

Tasks map_file_tasks(const std::filesystem::path& folder, const MappingResult& result,
                     const COccupancyGridMap2D& grid, const std::vector<MapEdit>& edits,
                     const MapFileOptions& options) {
  Tasks tasks;
  if (options.png) tasks.emplace_back([&grid, folder] { write_map_image(folder / "map.png", grid); });
  if (options.mrpt) tasks.emplace_back([&grid, folder] { write_mrpt_map(folder / "map.gridmap.gz", grid); });
  if (options.svg || options.dxf || options.gpkg)
    tasks.emplace_back([&, folder] {
      const MapDrawing drawing = draw_map_lines(grid, paths_of_runs(result), options.lines);
      if (options.svg) write_text_atomically(folder / "map.svg", map_svg(drawing, options.print_scale));
      if (options.dxf) write_text_atomically(folder / "map.dxf", map_dxf(drawing));
      if (options.gpkg)
        write_geo_package(folder / "map.gpkg", drawing.walls, trajectories_of_runs(result), edits,
                          options.earth);
    });
  if (options.ros) tasks.emplace_back([&grid, folder] { write_map_server_pair(folder / "map.yaml", grid); });
  if (options.geotiff)
    tasks.emplace_back(
        [&grid, &options, folder] { write_geo_tiff(folder / "map.tif", grid, options.earth); });
  return tasks;
}

}  // namespace psi_slam
