// SPDX-License-Identifier: BSD-3-Clause
// Colours and scale bar, shared by all images of the map.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace psi_slam {

using Pixel = cv::Vec4b;  ///< blue, green, red, opacity

inline const Pixel kWallInk{38, 28, 22, 255};
inline const Pixel kFreeInk{255, 255, 255, 255};
inline const Pixel kUnknownInk{232, 229, 226, 255};
inline const Pixel kTransparentInk{255, 255, 255, 0};

/// Position and size of a scale bar in an image, in pixels.
struct ScaleBarPlace {
  int left = 0;
  int middle = 0;  ///< row of the bar's middle
  int unit = 6;    ///< height of the end marks; the bar's other sizes are proportional to it
};

/// Returns the length in metres of the scale bar for an image `width_m` wide: 1, 2 or 5 times a power of ten,
/// not above a fifth of the width or, in tiny images, one pixel. `resolution_m` is the width of a pixel.
double scale_bar_m(double width_m, double resolution_m);

/// Draws a scale bar of `bar_m` metres with its length as text.
void draw_scale_bar(cv::Mat& image, const ScaleBarPlace& place, double bar_m, double resolution_m);

}  // namespace psi_slam
