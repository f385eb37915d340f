// SPDX-License-Identifier: BSD-3-Clause
#include "rendering/png_bytes.h"

#include <png.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <stdexcept>
#include <unordered_map>
#include <utility>
#include <vector>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMostColours = 256;

/// Numbers the colours of an image.
class Palette {
 public:
  explicit Palette(int channels) : channels_(channels) {}

  /// Returns the number of the pixel's colour; nothing if the colour is new and there are kMostColours.
  std::optional<std::uint8_t> number_of(const std::uint8_t* pixel) {
    std::uint32_t colour = 0;
    for (int i = 0; i < channels_; ++i) colour = colour << 8U | pixel[i];
    if (colour == last_) return number_;
    const auto found = numbers_.find(colour);
    if (found == numbers_.end() && numbers_.size() == kMostColours) return std::nullopt;
    number_ = found != numbers_.end() ? found->second : static_cast<std::uint8_t>(numbers_.size());
    if (found == numbers_.end()) {
      numbers_.emplace(colour, number_);
      colours_.insert(colours_.end(), pixel, pixel + channels_);
    }
    last_ = colour;
    return number_;
  }

  std::size_t size() const { return numbers_.size(); }
  /// Channels of the first colour, of the second, and so on.
  const std::vector<std::uint8_t>& colours() const { return colours_; }

 private:
  int channels_;
  std::unordered_map<std::uint32_t, std::uint8_t> numbers_;  ///< key: the channels of a colour
  std::vector<std::uint8_t> colours_;
  std::optional<std::uint32_t> last_;  ///< neighbours mostly have the same colour
  std::uint8_t number_ = 0;
};

/// Returns nothing if the image has more than kMostColours.
std::optional<Palette> palette_of(const cv::Mat& image) {
  Palette palette(image.channels());
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* pixel = image.ptr(y);
    for (int x = 0; x < image.cols; ++x, pixel += image.channels())
      if (!palette.number_of(pixel)) return std::nullopt;
  }
  return palette;
}

/// Overwrites the first bytes of a continuous image with the numbers of its colours. The byte for a
/// pixel is never after its first byte, so no pixel is overwritten before it is read.
void replace_by_numbers(Palette& palette, cv::Mat& image) {
  const std::uint8_t* pixel = image.data;
  for (std::size_t i = 0; i < image.total(); ++i, pixel += image.channels())
    image.data[i] = palette.number_of(pixel).value();
}

std::string encoded(Palette palette, cv::Mat& image) {
  const int channels = image.channels();
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.cols);
  png.height = static_cast<png_uint_32>(image.rows);
  png.format = PNG_FORMAT_FLAG_COLORMAP | (channels == 4 ? PNG_FORMAT_BGRA : PNG_FORMAT_BGR);
  png.colormap_entries = static_cast<png_uint_32>(palette.size());
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  // Most of this is not touched, and so takes no memory.
  const std::unique_ptr<char[]> bytes(new char[size]);  // NOLINT(modernize-avoid-c-arrays)
  replace_by_numbers(palette, image);
  if (png_image_write_to_memory(&png, bytes.get(), &size, 0, image.data, 0, palette.colours().data()) == 0)
    return {};
  return {bytes.get(), size};
}

std::string encoded(const cv::Mat& image) {
  constexpr int kCompression = 6;  // 9 takes much longer
  std::vector<std::uint8_t> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, kCompression})) return {};
  return {bytes.begin(), bytes.end()};
}

}  // namespace

std::string png_bytes(cv::Mat&& image) {
  if (image.type() != CV_8UC3 && image.type() != CV_8UC4)
    throw std::invalid_argument("png_bytes: the image has other channels than three or four of 8 bits");
  if (!image.isContinuous()) image = image.clone();
  std::optional<Palette> palette = palette_of(image);
  std::string bytes = palette ? encoded(*std::move(palette), image) : encoded(image);
  if (bytes.empty())
    throw SystemFailure("cannot encode the map as a PNG image. Use larger cells with map.resolution_m");
  return bytes;
}

}  // namespace psi_slam
