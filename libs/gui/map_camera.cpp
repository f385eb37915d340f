// SPDX-License-Identifier: BSD-3-Clause
#include "gui/map_camera.h"

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

constexpr double kMargin = 1.08;
constexpr double kNearest_m = 2;

double half_tangent(const MapCamera& camera) {
  return portable::tan(camera.field_of_view_deg * M_PI / 360);
}

}  // namespace

std::optional<mrpt::math::TPoint2D> ground_at(const MapCamera& camera, const mrpt::img::TImageSize& size,
                                              double x_px, double y_px) {
  const double azimuth = camera.azimuth_deg * M_PI / 180;
  const double elevation = camera.elevation_deg * M_PI / 180;
  const Eigen::Vector3d to_eye(portable::cos(azimuth) * portable::cos(elevation),
                               portable::sin(azimuth) * portable::cos(elevation), portable::sin(elevation));
  const Eigen::Vector3d right(-portable::sin(azimuth), portable::cos(azimuth), 0);
  const Eigen::Vector3d up = to_eye.cross(right);
  const double scale = half_tangent(camera);
  const double aspect = static_cast<double>(size.x) / std::max(1, size.y);
  const double across = (2 * x_px / std::max(1, size.x) - 1) * scale * aspect;
  const double above = (1 - 2 * y_px / std::max(1, size.y)) * scale;
  const Eigen::Vector3d direction = across * right + above * up - to_eye;
  if (direction.z() >= -1e-6) return std::nullopt;
  const double length = camera.distance_m * to_eye.z() / -direction.z();
  return mrpt::math::TPoint2D(camera.target.x + camera.distance_m * to_eye.x() + length * direction.x(),
                              camera.target.y + camera.distance_m * to_eye.y() + length * direction.y());
}

double ground_pixel_m(const MapCamera& camera, const mrpt::img::TImageSize& size) {
  constexpr double kLeastSine = 0.1;  // a camera at the horizon sees without end
  const double across_m = 2 * camera.distance_m * half_tangent(camera) / std::max(1, size.y);
  return across_m / std::max(kLeastSine, portable::sin(camera.elevation_deg * M_PI / 180));
}

MapCamera camera_above(const MapRectangle& rectangle, const mrpt::img::TImageSize& size) {
  MapCamera camera;
  camera.target = {(rectangle.x_min_m + rectangle.x_max_m) / 2, (rectangle.y_min_m + rectangle.y_max_m) / 2};
  const double aspect = static_cast<double>(std::max(1, size.x)) / std::max(1, size.y);
  const double half_height_m = std::max(rectangle.height_m() / 2, rectangle.width_m() / 2 / aspect);
  camera.distance_m = std::max(kNearest_m, kMargin * half_height_m / half_tangent(camera));
  return camera;
}

}  // namespace psi_slam
