// SPDX-License-Identifier: BSD-3-Clause
// PNG encoding of all images of the map.
#pragma once

#include <opencv2/core.hpp>
#include <string>

namespace psi_slam {

/// Returns an image (three or four channels of 8 bits, in the order of OpenCV) as the contents of a PNG file.
/// Images of at most 256 colours, as most of maps are, become images with a palette. These take a third of
/// the time. They have no opacity if all colours are opaque. Overwrites the image, because a copy of a large
/// one takes much memory. Throws SystemFailure if the image cannot be encoded, std::invalid_argument for
/// other channels.
std::string png_bytes(cv::Mat&& image);

}  // namespace psi_slam
