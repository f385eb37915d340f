// SPDX-License-Identifier: BSD-3-Clause
#include "logs/observations/cloud_points.h"

#include <mrpt/maps/CSimplePointsMap.h>
#include <mrpt/obs/CObservation3DRangeScan.h>
#include <mrpt/obs/CObservationPointCloud.h>
#include <mrpt/obs/CObservationRotatingScan.h>
#include <mrpt/obs/CObservationVelodyneScan.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <new>
#include <string>

#include "base/portable_math.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::obs::CObservation3DRangeScan;
using mrpt::obs::CObservationPointCloud;
using mrpt::obs::CObservationRotatingScan;
using mrpt::obs::CObservationVelodyneScan;
using Points = std::vector<mrpt::math::TPoint3Df>;

template <class Coordinates>
Points points_of(const Coordinates& x, const Coordinates& y, const Coordinates& z) {
  Points points(std::min({x.size(), y.size(), z.size()}));
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = {x[i], y[i], z[i]};
  return points;
}

Points points_of(const mrpt::maps::CPointsMap& map) {
  return points_of(map.getPointsBufferRef_x(), map.getPointsBufferRef_y(), map.getPointsBufferRef_z());
}

Points points_of(const CObservation3DRangeScan& scan) {
  if (scan.hasPoints3D) return points_of(scan.points3D_x, scan.points3D_y, scan.points3D_z);
  CObservation3DRangeScan with_points = scan;
  mrpt::maps::CSimplePointsMap map;
  with_points.unprojectInto(map, mrpt::obs::T3DPointsProjectionParams());
  return points_of(map);
}

Points points_of(const CObservationVelodyneScan& scan) {
  CObservationVelodyneScan with_points = scan;
  if (with_points.point_cloud.size() == 0) with_points.generatePointCloud();
  const auto& cloud = with_points.point_cloud;
  return points_of(cloud.x, cloud.y, cloud.z);
}

/// The class states no elevations of its rows, and the columns that MRPT makes of Velodyne's packets have
/// wrong azimuths, so only one row can be read.
Points points_of(const CObservationRotatingScan& scan) {
  if (scan.rowCount != 1)
    throw UserError("a CObservationRotatingScan has " + std::to_string(scan.rowCount) +
                    " rows, whose elevations it does not state, expected one row. Record or convert the "
                    "sensor's data as CObservationVelodyneScan or CObservationPointCloud");
  const double step_rad = scan.azimuthSpan / std::max<double>(scan.columnCount - 1, 1);
  Points points;
  for (int column = 0; column < scan.rangeImage.cols(); ++column) {
    const double range_m = scan.rangeImage(0, column) * scan.rangeResolution;
    if (range_m < scan.minRange || range_m > scan.maxRange || range_m == 0) continue;
    const double azimuth_rad = scan.startAzimuth + step_rad * column;
    points.emplace_back(static_cast<float>(range_m * portable::cos(azimuth_rad)),
                        static_cast<float>(range_m * portable::sin(azimuth_rad)), 0.0F);
  }
  return points;
}

Points points_of_cloud(const mrpt::obs::CObservation& observation) {
  observation.load();
  if (const auto* scan = dynamic_cast<const CObservation3DRangeScan*>(&observation)) return points_of(*scan);
  if (const auto* scan = dynamic_cast<const CObservationVelodyneScan*>(&observation)) return points_of(*scan);
  if (const auto* scan = dynamic_cast<const CObservationRotatingScan*>(&observation)) return points_of(*scan);
  const auto* cloud = dynamic_cast<const CObservationPointCloud*>(&observation);
  return cloud != nullptr && cloud->pointcloud ? points_of(*cloud->pointcloud) : Points();
}

}  // namespace

bool is_cloud(const mrpt::obs::CObservation& observation) {
  return dynamic_cast<const CObservation3DRangeScan*>(&observation) != nullptr ||
         dynamic_cast<const CObservationPointCloud*>(&observation) != nullptr ||
         dynamic_cast<const CObservationRotatingScan*>(&observation) != nullptr ||
         dynamic_cast<const CObservationVelodyneScan*>(&observation) != nullptr;
}

Points cloud_points(const mrpt::obs::CObservation& observation, const std::string& place) {
  try {
    return points_of_cloud(observation);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const UserError& error) {
    throw UserError(place + ": " + error.what());
  } catch (const std::exception&) {
    throw UserError(place + ": MRPT cannot read the points of an observation of class " +
                    observation.GetRuntimeClass()->className +
                    ". Check that its folder of external files is beside the log, or record the log again");
  }
}

}  // namespace psi_slam
