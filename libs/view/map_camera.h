// SPDX-License-Identifier: BSD-3-Clause
// MRPT's orbiting camera over the ground plane: what a pixel shows, and from where all of a map is seen.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <optional>

namespace psi_slam {

struct MapCamera {
  mrpt::math::TPoint2D target;    ///< the point of the ground in the middle of the picture
  double distance_m = 40;         ///< of the eye from it
  double azimuth_deg = -90;       ///< of the eye, seen from the target; -90: y points up
  double elevation_deg = 90;      ///< 90: from straight above
  double field_of_view_deg = 30;  ///< from the lower to the upper edge
};

struct PictureSize {
  int width_px = 1;
  int height_px = 1;
};

/// The point of the ground that a pixel shows, from the upper left; none above the horizon.
std::optional<mrpt::math::TPoint2D> ground_at(const MapCamera& camera, const PictureSize& size, double x_px,
                                              double y_px);

struct GroundRectangle {
  mrpt::math::TPoint2D min;
  mrpt::math::TPoint2D max;
};

/// Looks straight down on all of the rectangle, with a little around it, keeping the azimuth -90.
MapCamera camera_above(const GroundRectangle& rectangle, const PictureSize& size);

}  // namespace psi_slam
