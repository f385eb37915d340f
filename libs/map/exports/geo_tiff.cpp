// SPDX-License-Identifier: BSD-3-Clause
#include <cpl_error.h>
#include <cpl_string.h>
#include <gdal_frmts.h>
#include <gdal_priv.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "base/portable_math.h"
#include "map/exports/gdal_files.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::maps::COccupancyGridMap2D;

constexpr std::uint8_t kNotSeen = 255;

/// Rounds a length to the precision of map.yaml, 0.1 mm. MRPT stores lengths as floats.
double to_tenth_of_a_millimetre(float length_m) {
  return std::round(static_cast<double>(length_m) * 1e4) / 1e4;
}

/// GDAL's affine transform from column and row (from the upper left corner) to easting and northing.
std::array<double, 6> geo_transform(const COccupancyGridMap2D& grid, const GeoReference& reference) {
  const double c = portable::cos(reference.heading_rad);
  const double s = portable::sin(reference.heading_rad);
  const double cell_m = std::round(static_cast<double>(grid.getResolution()) * 1e7) / 1e7;
  const double x = to_tenth_of_a_millimetre(grid.getXMin());
  const double y = to_tenth_of_a_millimetre(grid.getYMin()) + cell_m * static_cast<double>(grid.getSizeY());
  const auto corner = on_earth({x, y}, reference);
  return {corner.x, c * cell_m, s * cell_m, corner.y, s * cell_m, -c * cell_m};
}

std::vector<std::uint8_t> occupancy_percent(const COccupancyGridMap2D& grid, int row_from_top) {
  const auto* cells = grid.getRow(static_cast<int>(grid.getSizeY()) - 1 - row_from_top);
  std::vector<std::uint8_t> percent(grid.getSizeX());
  const auto unknown = COccupancyGridMap2D::p2l(0.5F);
  std::transform(cells, cells + percent.size(), percent.begin(), [&](COccupancyGridMap2D::cellType cell) {
    if (cell == unknown) return kNotSeen;
    return static_cast<std::uint8_t>(std::lround(100 * (1 - COccupancyGridMap2D::l2p(cell))));
  });
  return percent;
}

bool write_rows(GDALRasterBand& band, const COccupancyGridMap2D& grid) {
  const int width = band.GetXSize();
  for (int row = 0; row < band.GetYSize(); ++row) {
    std::vector<std::uint8_t> percent = occupancy_percent(grid, row);
    if (band.RasterIO(GF_Write, 0, row, width, 1, percent.data(), width, 1, GDT_Byte, 0, 0) != CE_None)
      return false;
  }
  return true;
}

bool write_to(const std::string& name, const COccupancyGridMap2D& grid, const GeoReference& reference) {
  GDALRegister_GTiff();
  GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GTiff");
  if (driver == nullptr) return false;
  CPLStringList options;
  options.SetNameValue("COMPRESS", "DEFLATE");
  options.SetNameValue("TILED", "YES");
  const std::unique_ptr<GDALDataset> file(driver->Create(name.c_str(), static_cast<int>(grid.getSizeX()),
                                                         static_cast<int>(grid.getSizeY()), 1, GDT_Byte,
                                                         options.List()));
  if (!file) return false;
  const OGRSpatialReference system = spatial_reference(reference.epsg, "psi-slam map");
  std::array<double, 6> transform = geo_transform(grid, reference);
  GDALRasterBand& band = *file->GetRasterBand(1);
  band.SetDescription("occupancy [percent]");
  const bool written = file->SetSpatialRef(&system) == CE_None &&
                       file->SetGeoTransform(transform.data()) == CE_None &&
                       band.SetNoDataValue(kNotSeen) == CE_None && write_rows(band, grid);
  file->FlushCache(false);
  return written && CPLGetLastErrorType() < CE_Failure;
}

}  // namespace

void write_geo_tiff(const std::filesystem::path& path, const COccupancyGridMap2D& grid,
                    const GeoReference& reference) {
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  CPLErrorReset();
  const MemoryFile memory(".tif");
  if (!write_to(memory.name(), grid, reference))
    throw SystemFailure("cannot write " + path.string() + ": " + CPLGetLastErrorMsg());
  write_text_atomically(path, memory.bytes());
}

}  // namespace psi_slam
