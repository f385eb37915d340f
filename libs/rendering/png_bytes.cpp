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
#include <vector>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMostColours = 256;

/// An image of few colours.
struct IndexedImage {
  std::vector<std::uint8_t> colours;  ///< channels of the first colour, of the second, and so on
  std::vector<std::uint8_t> pixels;   ///< number of the colour of each pixel, row by row
};

/// Returns nothing if the image has more than kMostColours.
std::optional<IndexedImage> indexed(const cv::Mat& image) {
  const int channels = image.channels();
  IndexedImage result;
  result.pixels.reserve(image.total());
  std::unordered_map<std::uint32_t, std::uint8_t> numbers;  // key: the channels of a colour
  std::optional<std::uint32_t> last;                        // neighbours mostly have the same colour
  std::uint8_t number = 0;
  for (int y = 0; y < image.rows; ++y) {
    const std::uint8_t* pixel = image.ptr(y);
    for (int x = 0; x < image.cols; ++x, pixel += channels) {
      std::uint32_t colour = 0;
      for (int i = 0; i < channels; ++i) colour = colour << 8U | pixel[i];
      if (colour != last) {
        const auto found = numbers.find(colour);
        if (found == numbers.end() && numbers.size() == kMostColours) return std::nullopt;
        number = found != numbers.end() ? found->second : static_cast<std::uint8_t>(numbers.size());
        if (found == numbers.end()) {
          numbers.emplace(colour, number);
          result.colours.insert(result.colours.end(), pixel, pixel + channels);
        }
        last = colour;
      }
      result.pixels.push_back(number);
    }
  }
  return result;
}

std::string encoded(const IndexedImage& indexed, const cv::Mat& image) {
  const int channels = image.channels();
  png_image png = {};
  png.version = PNG_IMAGE_VERSION;
  png.width = static_cast<png_uint_32>(image.cols);
  png.height = static_cast<png_uint_32>(image.rows);
  png.format = PNG_FORMAT_FLAG_COLORMAP | (channels == 4 ? PNG_FORMAT_BGRA : PNG_FORMAT_BGR);
  png.colormap_entries = static_cast<png_uint_32>(indexed.colours.size()) / static_cast<unsigned>(channels);
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(png);
  // Most of this is not touched, and so takes no memory.
  const std::unique_ptr<char[]> bytes(new char[size]);  // NOLINT(modernize-avoid-c-arrays)
  if (png_image_write_to_memory(&png, bytes.get(), &size, 0, indexed.pixels.data(), 0,
                                indexed.colours.data()) == 0)
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

std::string png_bytes(const cv::Mat& image) {
  if (image.type() != CV_8UC3 && image.type() != CV_8UC4)
    throw std::invalid_argument("png_bytes: the image has other channels than three or four of 8 bits");
  const std::optional<IndexedImage> of_few_colours = indexed(image);
  std::string bytes = of_few_colours ? encoded(*of_few_colours, image) : encoded(image);
  if (bytes.empty())
    throw SystemFailure("cannot encode the map as a PNG image. Use larger cells with map.resolution_m");
  return bytes;
}

}  // namespace psi_slam
