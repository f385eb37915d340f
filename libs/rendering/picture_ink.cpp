// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/picture_ink.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "base/number_text.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Rounds down to 1, 2 or 5 times a power of ten.
double round_length(double length_m) {
  const double power = std::pow(10, std::floor(std::log10(length_m)));
  for (const double digit : {5.0, 2.0})
    if (digit * power <= length_m) return digit * power;
  return power;
}

}  // namespace

double scale_bar_m(double width_m, double resolution_m) {
  return round_length(std::max(width_m / 5, resolution_m));
}

void draw_scale_bar(cv::Mat& image, const ScaleBarPlace& place, double bar_m, double resolution_m,
                    const std::string& note) {
  const int unit = place.unit;
  const int bar_px = static_cast<int>(std::lround(bar_m / resolution_m));
  const cv::Scalar ink = scalar_of(kWallInk);
  const int thick = std::max(1, unit / 4);
  cv::rectangle(image, {place.left, place.middle - thick / 2, bar_px, thick}, ink, cv::FILLED);
  for (const int end : {place.left, place.left + bar_px - thick})
    cv::rectangle(image, {end, place.middle - unit / 2, thick, unit}, ink, cv::FILLED);
  const std::string label = fixed_text(bar_m, bar_m < 1 ? 2 : 0) + " m";
  cv::putText(image, label + note, {place.left + bar_px + unit, place.middle + unit / 2},
              cv::FONT_HERSHEY_DUPLEX, unit / 15.0, ink, std::max(1, unit / 10), cv::LINE_AA);
}

std::string png_bytes(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, 9}))
    throw SystemFailure("cannot encode the map as a PNG picture");
  return {bytes.begin(), bytes.end()};
}

}  // namespace psi_slam
