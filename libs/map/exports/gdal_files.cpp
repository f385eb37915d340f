// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/gdal_files.h"

#include <cpl_error.h>
#include <cpl_vsi.h>

#include <cmath>
#include <cstdint>

#include "base/portable_math.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

MemoryFile::MemoryFile(const std::string& extension)
    : name_("/vsimem/psi-slam-" + std::to_string(reinterpret_cast<std::uintptr_t>(this)) + extension) {}

MemoryFile::~MemoryFile() {
  VSIUnlink(name_.c_str());
}

std::string_view MemoryFile::bytes() const {
  vsi_l_offset size = 0;
  const void* bytes = VSIGetMemFileBuffer(name_.c_str(), &size, FALSE);
  return {static_cast<const char*>(bytes), bytes == nullptr ? 0 : static_cast<std::size_t>(size)};
}

OGRSpatialReference spatial_reference(int epsg, const char* local_name) {
  const std::string what = "map.epsg = " + std::to_string(epsg);
  OGRSpatialReference system;
  if (epsg == 0) {
    system.SetLocalCS(local_name);
    system.SetLinearUnits(SRS_UL_METER, 1);
    return system;
  }
  if (system.importFromEPSG(epsg) != OGRERR_NONE)
    throw UserError(what +
                    ": no such coordinate system. Give the EPSG number of a projected system in metres");
  if (system.IsProjected() == 0 || std::abs(system.GetLinearUnits() - 1) > 1e-12)
    throw UserError(what + " (" + system.GetName() +
                    "): expected a projected coordinate system in metres, such as UTM");
  return system;
}

void check_epsg(int epsg) {
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  spatial_reference(epsg, "psi-slam map");
}

mrpt::math::TPoint2D on_earth(const mrpt::math::TPoint2D& map_point_m, const GeoReference& reference) {
  const double c = portable::cos(reference.heading_rad);
  const double s = portable::sin(reference.heading_rad);
  return {reference.easting_m + c * map_point_m.x - s * map_point_m.y,
          reference.northing_m + s * map_point_m.x + c * map_point_m.y};
}

}  // namespace psi_slam
