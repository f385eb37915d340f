// SPDX-License-Identifier: BSD-3-Clause
// An orbit camera over the ground plane, with the parameters of MRPT's camera. Converts pixels to places on
// the ground, and finds a view of a whole map.
#pragma once

#include <mrpt/img/TPixelCoord.h>
#include <mrpt/math/TPoint2D.h>

#include <optional>

#include "map/rendering/map_image.h"

namespace psi_slam {

struct MapCamera {
  mrpt::math::TPoint2D target;    ///< place on the ground in the middle of the image
  double distance_m = 40;         ///< distance from the target to the eye
  double azimuth_deg = -90;       ///< azimuth of the eye, seen from the target; at -90, y points up
  double elevation_deg = 90;      ///< elevation of the eye; 90 looks straight down
  double field_of_view_deg = 30;  ///< vertical: from the lower to the upper edge of the image
};

/// Place on the ground that a pixel shows in an image of `size` pixels; (0, 0) is the upper left corner.
/// Returns nothing if the pixel is above the horizon.
std::optional<mrpt::math::TPoint2D> ground_at(const MapCamera& camera, const mrpt::img::TImageSize& size,
                                              double x_px, double y_px);

/// Width of the ground that a pixel in the middle of an image of `size` pixels shows, in metres. A tilted
/// camera sees more ground along its direction; returns the larger width.
double ground_pixel_m(const MapCamera& camera, const mrpt::img::TImageSize& size);

/// Camera that looks straight down on the whole rectangle with a small margin, at azimuth -90.
MapCamera camera_above(const MapRectangle& rectangle, const mrpt::img::TImageSize& size);

}  // namespace psi_slam
