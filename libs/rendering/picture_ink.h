// SPDX-License-Identifier: BSD-3-Clause
// What the pictures of the map share: their colours, the scale bar, and how they become a PNG file.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace psi_slam {

using Pixel = cv::Vec4b;  // blue, green, red, opacity

inline const Pixel kWallInk{38, 28, 22, 255};
inline const Pixel kFreeInk{255, 255, 255, 255};
inline const Pixel kUnknownInk{232, 229, 226, 255};
inline const Pixel kTransparentInk{255, 255, 255, 0};

inline cv::Scalar scalar_of(const Pixel& pixel) {
  return {static_cast<double>(pixel[0]), static_cast<double>(pixel[1]), static_cast<double>(pixel[2]),
          static_cast<double>(pixel[3])};
}

/// Where a scale bar stands in a picture, in pixels.
struct ScaleBarPlace {
  int left = 0;
  int middle = 0;  ///< row of the bar's middle
  int unit = 6;    ///< height of the bar's ends; all its measures follow it
};

/// The length of a bar of about a fifth of a width: 1, 2 or 5 times a power of ten.
double scale_bar_m(double width_m, double resolution_m);

/// Draws the bar with its length, and `note` behind that.
void draw_scale_bar(cv::Mat& image, const ScaleBarPlace& place, double bar_m, double resolution_m,
                    const std::string& note = {});

/// The file's bytes; `image` has one, three or four channels. Throws SystemFailure when there is no making
/// it.
std::string png_bytes(const cv::Mat& image);

}  // namespace psi_slam
