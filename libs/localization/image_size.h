// SPDX-License-Identifier: BSD-3-Clause
// Size of an image by the header of its file. Programs that decode images allocate what the header states, so
// it is checked first.
#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace psi_slam {

struct ImageSize {
  std::uint64_t width = 0;   ///< pixels
  std::uint64_t height = 0;  ///< pixels
};

/// Reads the size of a PNG, PNM (PBM, PGM, PPM), BMP or JPEG image from the first bytes of its file. Empty if
/// the bytes are no such image, or end before the size.
std::optional<ImageSize> image_size(std::string_view bytes);

/// Returns whether the bytes of a file, of which image_size() reads the size, hold all pixels: whether a PNM
/// image has a number for each, and a PNG image has all parts with their checksums. True for BMP and JPEG.
bool holds_all_pixels(std::string_view bytes);

/// Returns the maximum sample value of a PNM image if OpenCV leaves its samples unscaled; otherwise nothing.
std::optional<double> white_sample(std::string_view bytes);

}  // namespace psi_slam
