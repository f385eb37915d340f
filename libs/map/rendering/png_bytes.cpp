// SPDX-License-Identifier: BSD-3-Clause
#include "map/rendering/png_bytes.h"

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
template <int kChannels>
class Palette {
 public:
  /// Returns the number of the pixel's colour; nothing if the colour is new and there are kMostColours.
  std::optional<std::uint8_t> number_of(const std::uint8_t* pixel) {
    std::uint32_t colour = 0;
    for (int i = 0; i < kChannels; ++i) colour = colour << 8U | pixel[i];
    if (colour == last_) return number_;
    const auto found = numbers_.find(colour);
    if (found == numbers_.end() && numbers_.size() == kMostColours) return std::nullopt;
    number_ = found != numbers_.end() ? found->second : static_cast<std::uint8_t>(numbers_.size());
    if (found == numbers_.end()) {
      numbers_.emplace(colour, number_);
      colours_.insert(colours_.end(), pixel, pixel + kChannels);
    }
    last_ = colour;
    return number_;
  }

  std::size_t size() const { return numbers_.size(); }
  /// Channels of the first colour, of the second, and so on.
  const std::vector<std::uint8_t>& colours() const { return colours_; }

 private:
  std::unordered_map<std::uint32_t, std::uint8_t> numbers_;  ///< key: the channels of a colour
  std::vector<std::uint8_t> colours_;
  std::optional<std::uint32_t> last_;  ///< neighbours mostly have the same colour
  std::uint8_t number_ = 0;
};

/// Numbers the colours of a continuous image. Returns nothing if there are more than kMostColours.
template <int kChannels>
std::optional<Palette<kChannels>> palette_of(const cv::Mat& image) {
  Palette<kChannels> palette;
  const std::uint8_t* const end = image.data + kChannels * image.total();
  for (const std::uint8_t* pixel = image.data; pixel != end; pixel += kChannels)
    if (!palette.number_of(pixel)) return std::nullopt;
  return palette;
}

/// Overwrites the first bytes of a continuous image with the numbers of its colours. The byte for a
/// pixel is never after its first byte, so no pixel is overwritten before it is read.
template <int kChannels>
void replace_by_numbers(Palette<kChannels>& palette, cv::Mat& image) {
  const std::uint8_t* pixel = image.data;
  std::uint8_t* const numbers = image.data;
  const std::size_t pixels = image.total();
  for (std::size_t i = 0; i < pixels; ++i, pixel += kChannels) numbers[i] = palette.number_of(pixel).value();
}

template <int kChannels>
std::string encoded(Palette<kChannels> palette, cv::Mat& image) {
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.cols);
  png.height = static_cast<png_uint_32>(image.rows);
  png.format = PNG_FORMAT_FLAG_COLORMAP | (kChannels == 4 ? PNG_FORMAT_BGRA : PNG_FORMAT_BGR);
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

template <int kChannels>
std::string with_palette_if_possible(cv::Mat& image) {
  std::optional<Palette<kChannels>> palette = palette_of<kChannels>(image);
  return palette ? encoded(*std::move(palette), image) : encoded(image);
}

}  // namespace

std::string png_bytes(cv::Mat&& image) {
  if (image.type() != CV_8UC3 && image.type() != CV_8UC4)
    throw std::invalid_argument("png_bytes: the image has other channels than three or four of 8 bits");
  if (!image.isContinuous()) image = image.clone();
  std::string bytes =
      image.channels() == 3 ? with_palette_if_possible<3>(image) : with_palette_if_possible<4>(image);
  if (bytes.empty())
    throw SystemFailure("cannot encode the map as a PNG image. Use larger cells with map.resolution_m");
  return bytes;
}

}  // namespace psi_slam
