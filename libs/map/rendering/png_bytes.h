// SPDX-License-Identifier: BSD-3-Clause
// PNG encoding of all images of the map.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace psi_slam {

/// Returns an image (three or four channels of 8 bits, in the order of OpenCV) as the contents of a PNG file.
/// Images of at most 256 colours, such as most maps, get a palette, because writing them then takes a third
/// of the time. The palette has no opacity if all colours are opaque. Overwrites the image, because a copy of
/// a large image takes much memory. Throws SystemFailure if the image cannot be encoded,
/// std::invalid_argument for other channels.
std::string png_bytes(cv::Mat&& image);

}  // namespace psi_slam
