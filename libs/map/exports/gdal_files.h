// SPDX-License-Identifier: BSD-3-Clause
// What the files that GDAL writes have in common: they are made in memory, and placed on the earth.
#pragma once

#include <mrpt/math/TPoint2D.h>
#include <ogr_spatialref.h>

#include <string>
#include <string_view>

#include "map/exports/map_files.h"

namespace psi_slam {

/// A file in the memory of GDAL, deleted by the destructor.
class MemoryFile {
 public:
  /// `extension` begins with a full stop, such as ".tif".
  explicit MemoryFile(const std::string& extension);
  ~MemoryFile();
  MemoryFile(const MemoryFile&) = delete;
  MemoryFile& operator=(const MemoryFile&) = delete;

  const std::string& name() const { return name_; }
  /// Returns the content; empty if the file does not exist.
  std::string_view bytes() const;

 private:
  std::string name_;
};

/// Returns the projected coordinate system in metres with this EPSG number, or for 0 a local system in metres
/// called `local_name`. Throws UserError like check_epsg().
OGRSpatialReference spatial_reference(int epsg, const char* local_name);

/// Returns easting and northing of a point of the map.
mrpt::math::TPoint2D on_earth(const mrpt::math::TPoint2D& map_point_m, const GeoReference& reference);

}  // namespace psi_slam
