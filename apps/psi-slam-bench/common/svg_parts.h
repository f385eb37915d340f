// SPDX-License-Identifier: BSD-3-Clause
// What the benchmark's plots, SVG files of their own, are put together from.
#pragma once

#include <string>

namespace psi_slam {

/// `content` is plain text. `attributes` are the element's own: "text-anchor=\"end\"".
std::string svg_text(double x, double y, const std::string& attributes, const std::string& content);

/// A whole file, white, of that size in pixels.
std::string svg_page(double width, double height, const std::string& content);

}  // namespace psi_slam
