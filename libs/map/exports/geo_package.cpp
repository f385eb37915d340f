// SPDX-License-Identifier: BSD-3-Clause
#include <cpl_conv.h>
#include <cpl_error.h>
#include <cpl_string.h>
#include <cpl_time.h>
#include <gdal_priv.h>
#include <ogrsf_frmts.h>

#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "base/atomic_file.h"
#include "map/exports/gdal_files.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Kind = MapEdit::Kind;
using mrpt::math::TPoint2D;

/// The name by which GDAL recognises the local system that GeoPackage predefines, srs_id -1.
constexpr const char* kLocalSystem = "Undefined Cartesian SRS";

/// Returns "2026-11-25T15:04:05.678Z".
std::string utc_text(TimeUs time_us) {
  constexpr TimeUs kMsPerS = 1000;
  TimeUs time_ms = time_us / kMsPerS;
  if (time_us % kMsPerS < 0) --time_ms;
  TimeUs ms = time_ms % kMsPerS;
  if (ms < 0) ms += kMsPerS;
  std::tm date{};
  CPLUnixTimeToYMDHMS((time_ms - ms) / kMsPerS, &date);
  char text[64];
  std::snprintf(text, sizeof text, "%04d-%02d-%02dT%02d:%02d:%02d.%03dZ", date.tm_year + 1900,
                date.tm_mon + 1, date.tm_mday, date.tm_hour, date.tm_min, date.tm_sec, static_cast<int>(ms));
  return text;
}

TimeUs last_time_us(const std::vector<Trajectory>& runs) {
  return runs.empty() || runs.back().empty() ? 0 : runs.back().back().time_us;
}

/// Throws the message of GDAL unless `done`.
void require(bool done) {
  if (!done) throw SystemFailure(CPLGetLastErrorMsg());
}

/// A GeoPackage that is being written, with layers in one coordinate system.
class GeoPackage {
 public:
  struct Field {
    const char* name;
    OGRFieldType type;
  };

  GeoPackage(const std::string& name, const GeoReference& reference)
      : reference_(reference), system_(spatial_reference(reference.epsg, kLocalSystem)) {
    RegisterOGRGeoPackage();
    GDALDriver* const driver = GetGDALDriverManager()->GetDriverByName("GPKG");
    require(driver != nullptr);
    file_.reset(driver->Create(name.c_str(), 0, 0, 0, GDT_Unknown, nullptr));
    require(file_ != nullptr && file_->StartTransaction() == OGRERR_NONE);
  }

  void add_layer(const char* name, const char* description, OGRwkbGeometryType type,
                 const std::vector<Field>& fields) {
    CPLStringList options;
    options.SetNameValue("DESCRIPTION", description);
    layer_ = file_->CreateLayer(name, &system_, type, options.List());
    require(layer_ != nullptr);
    for (const Field& field : fields) {
      OGRFieldDefn definition(field.name, field.type);
      require(layer_->CreateField(&definition) == OGRERR_NONE);
    }
  }

  /// Adds a feature to the last layer. `fill` sets its fields.
  void add(
      const OGRGeometry& geometry, const std::function<void(OGRFeature&)>& fill = [](OGRFeature&) {}) {
    OGRFeature feature(layer_->GetLayerDefn());
    fill(feature);
    require(feature.SetGeometry(&geometry) == OGRERR_NONE);
    require(layer_->CreateFeature(&feature) == OGRERR_NONE);
  }

  /// Appends a point of the map to a line.
  void append(const TPoint2D& map_point_m, OGRLineString& line) const {
    const TPoint2D point = on_earth(map_point_m, reference_);
    line.addPoint(point.x, point.y);
  }

  /// Appends the position of a pose in the map, and its time as M.
  void append(const StampedPose& stamped, OGRLineString& line) const {
    const TPoint2D point = on_earth({stamped.pose.x, stamped.pose.y}, reference_);
    line.addPointM(point.x, point.y, seconds(stamped.time_us));
  }

  void close() {
    require(file_->CommitTransaction() == OGRERR_NONE);
    file_.reset();
    require(CPLGetLastErrorType() < CE_Failure);
  }

 private:
  GeoReference reference_;
  OGRSpatialReference system_;
  std::unique_ptr<GDALDataset> file_;
  OGRLayer* layer_ = nullptr;
};

void add_walls(const std::vector<MapLine>& walls, GeoPackage& package) {
  package.add_layer("walls", "Outlines of walls", wkbLineString, {});
  for (const MapLine& wall : walls) {
    OGRLineString line;
    for (const TPoint2D& point : wall) package.append(point, line);
    if (wall.size() > 2) package.append(wall.front(), line);
    package.add(line);
  }
}

void add_path(const std::vector<Trajectory>& runs, GeoPackage& package) {
  package.add_layer("path", "Path of the robot; M is the time in seconds", wkbLineStringM,
                    {{"run", OFTInteger}, {"start", OFTDateTime}, {"end", OFTDateTime}});
  for (std::size_t run = 0; run < runs.size(); ++run) {
    if (runs[run].size() < 2) continue;
    OGRLineString line;
    for (const StampedPose& pose : runs[run]) package.append(pose, line);
    package.add(line, [&](OGRFeature& feature) {
      feature.SetField("run", static_cast<int>(run + 1));
      feature.SetField("start", utc_text(runs[run].front().time_us).c_str());
      feature.SetField("end", utc_text(runs[run].back().time_us).c_str());
    });
  }
}

void add_zones(const std::vector<MapEdit>& edits, Kind kind, GeoPackage& package) {
  int number = 0;
  for (const MapEdit& edit : edits) {
    if (edit.is_zone()) ++number;
    if (edit.kind != kind) continue;
    OGRLinearRing ring;
    for (const TPoint2D& point : edit.points) package.append(point, ring);
    ring.closeRings();
    OGRPolygon polygon;
    polygon.addRing(&ring);
    package.add(polygon, [&](OGRFeature& feature) {
      feature.SetField("zone", number);
      if (edit.percent > 0) feature.SetField("percent", edit.percent);
      if (edit.max_speed_mps > 0) feature.SetField("max_speed_mps", edit.max_speed_mps);
    });
  }
}

}  // namespace

void write_geo_package(const std::filesystem::path& path, const std::vector<MapLine>& walls,
                       const std::vector<Trajectory>& runs, const std::vector<MapEdit>& edits,
                       const GeoReference& reference) {
  const CPLErrorHandlerPusher quiet(CPLQuietErrorHandler);
  CPLErrorReset();
  // Equal maps give equal bytes at any time, on any number of processors.
  const CPLConfigOptionSetter date("OGR_CURRENT_DATE", utc_text(last_time_us(runs)).c_str(), false);
  const CPLConfigOptionSetter threads("OGR_GPKG_ALLOW_THREADED_RTREE", "NO", false);
  const MemoryFile memory(".gpkg");
  try {
    GeoPackage package(memory.name(), reference);
    add_walls(walls, package);
    add_path(runs, package);
    package.add_layer("keep_out", "Zones that robots must not enter", wkbPolygon, {{"zone", OFTInteger}});
    add_zones(edits, Kind::kKeepOut, package);
    package.add_layer("slow", "Zones in which robots must be slow", wkbPolygon,
                      {{"zone", OFTInteger}, {"percent", OFTReal}, {"max_speed_mps", OFTReal}});
    add_zones(edits, Kind::kSlow, package);
    package.close();
  } catch (const SystemFailure& failure) {
    throw SystemFailure("cannot write " + path.string() + ": " + failure.what());
  }
  write_text_atomically(path, memory.bytes());
}

}  // namespace psi_slam
