// SPDX-License-Identifier: BSD-3-Clause
#include "localization/map_server_file.h"

#include <mrpt/containers/yaml.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <limits>
#include <opencv2/imgcodecs.hpp>
#include <optional>
#include <string>
#include <utility>

#include "base/file_bytes.h"
#include "base/number_text.h"
#include "base/portable_math.h"
#include "base/yaml_directives.h"
#include "localization/image_size.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Grid = mrpt::maps::COccupancyGridMap2D;
using Yaml = mrpt::containers::yaml;
using mrpt::math::TPose2D;

constexpr Grid::cellType kOccupied = -std::numeric_limits<Grid::cellType>::max();
constexpr Grid::cellType kFree = std::numeric_limits<Grid::cellType>::max();
constexpr Grid::cellType kUnknown = 0;

const char* const kOriginExpected = "a list of two or three numbers: x and y in metres, yaw in radians";

/// Reads the values of a map.yaml. Throws UserError that names the key.
class MapKeys {
 public:
  explicit MapKeys(const std::filesystem::path& path) : path_(path.string()) {
    try {
      if (!has_yaml_directive(path)) yaml_ = Yaml::FromFile(path_);
    } catch (const std::exception&) {  // not a YAML file
    }
    if (!yaml_ || !yaml_->isMap())
      throw UserError(path_ +
                      " is not a map of map_server, expected a YAML file with the keys image, "
                      "resolution, origin, negate, occupied_thresh and free_thresh. Export the map again");
  }

  bool has(const std::string& key) const { return yaml_->has(key); }

  std::string text(const std::string& key) const {
    try {
      return (*yaml_)[key].as<std::string>();
    } catch (const std::exception&) {
      fail(key, "a value");
    }
  }

  double number(const std::string& key) const {
    if (const auto number = parse_number(text(key))) return *number;
    fail(key, "a number");
  }

  /// Number at a place of the list `origin`; empty if the list is shorter.
  std::optional<double> number_of_origin(std::size_t place) const {
    try {
      const auto& list = (*yaml_)["origin"].asSequence();
      if (place >= list.size()) return std::nullopt;
      std::string text = list.at(place).as<std::string>();
      if (const auto number = parse_number(text)) return *number;
      for (char& c : text) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
      if (text == "nan" || text == "-nan" || text == ".nan") return std::numeric_limits<double>::quiet_NaN();
    } catch (const std::exception&) {  // it is no list
    }
    fail("origin", kOriginExpected);
  }

  [[noreturn]] void fail(const std::string& key, const std::string& expected) const {
    throw UserError(path_ + (has(key) ? ": the key " + key + " is invalid" : " lacks the key " + key) +
                    ", expected " + expected + ". Correct the file, or export the map again");
  }

 private:
  std::string path_;
  std::optional<Yaml> yaml_;
};

TPose2D origin_of(const MapKeys& keys) {
  const auto coordinate = [&](std::size_t place) {
    const double metres = keys.number_of_origin(place).value_or(std::nan(""));
    if (!std::isfinite(metres)) keys.fail("origin", kOriginExpected);
    return metres;
  };
  const double yaw_rad = keys.number_of_origin(2).value_or(0);
  return {coordinate(0), coordinate(1), std::isfinite(yaw_rad) ? yaw_rad : 0};
}

bool is_true(const MapKeys& keys, const std::string& key) {
  const std::string text = keys.text(key);
  return text == "true" || text == "True" || (text != "false" && text != "False" && keys.number(key) != 0);
}

MapImageMode mode_of(const MapKeys& keys) {
  const std::string mode = keys.has("mode") ? keys.text("mode") : "trinary";
  if (mode == "scale") return MapImageMode::kScale;
  if (mode == "raw") return MapImageMode::kRaw;
  if (mode != "trinary") keys.fail("mode", "trinary, scale or raw");
  return MapImageMode::kTrinary;
}

/// Empty if OpenCV cannot read the image.
std::optional<cv::Mat> decoded(const std::filesystem::path& path) {
  try {
    cv::Mat image = cv::imread(path.string(), cv::IMREAD_UNCHANGED);
    if (!image.empty()) return image;
  } catch (const cv::Exception&) {  // such as for more pixels than OpenCV's limit
  }
  return std::nullopt;
}

/// Cells of an image, by the rules of map_server.
class ImageCells {
 public:
  ImageCells(const MapServerFile& file, cv::Mat image) : file_(file), image_(std::move(image)) {
    is_wide_ = image_.depth() == CV_16U;
    white_ = white_sample(file_bytes(file.image)).value_or(is_wide_ ? 65535 : 255);
    opaque_ = is_wide_ ? 65535 : 255;
  }

  int width() const { return image_.cols; }
  int height() const { return image_.rows; }

  /// Cell of a pixel; row 0 is at the lower edge.
  Grid::cellType at(int column, int row) const {
    const int channels = image_.channels();
    const int colours = channels > 3 ? 3 : channels;
    if (channels > 3 && 2 * sample(column, row, 3) < opaque_) return kUnknown;
    double sum = 0;
    for (int colour = 0; colour < colours; ++colour) sum += sample(column, row, colour);
    const double brightness = std::min(sum / (colours * white_), 1.0);
    return cell_of(file_.negate ? brightness : 1 - brightness, brightness);
  }

 private:
  double sample(int column, int row, int channel) const {
    const int line = image_.rows - 1 - row;
    const int place = column * image_.channels() + channel;
    return is_wide_ ? image_.ptr<std::uint16_t>(line)[place] : image_.ptr<std::uint8_t>(line)[place];
  }

  Grid::cellType cell_of(double occupancy, double brightness) const {
    if (file_.mode == MapImageMode::kRaw) {  // the value of a pixel is the occupancy in percent
      const double percent = std::round(255 * brightness);
      return percent > 100 ? kUnknown : scaled(percent / 100);
    }
    if (occupancy > file_.occupied_threshold) return kOccupied;
    if (occupancy < file_.free_threshold) return kFree;
    if (file_.mode == MapImageMode::kTrinary) return kUnknown;
    return scaled((occupancy - file_.free_threshold) / (file_.occupied_threshold - file_.free_threshold));
  }

  static Grid::cellType scaled(double occupancy) {
    constexpr float kSure = 0.99F;
    return Grid::p2l(std::clamp(static_cast<float>(1 - occupancy), 1 - kSure, kSure));
  }

  const MapServerFile& file_;
  cv::Mat image_;
  bool is_wide_ = false;
  double white_ = 255;
  double opaque_ = 255;
};

/// Draws a turned image into a grid that holds it.
void draw_turned(const MapServerFile& file, const ImageCells& cells, Grid& grid) {
  const double resolution_m = file.resolution_m;
  const TPose2D& origin = file.map_T_image;
  const auto [sin, cos] = portable::sin_cos(origin.phi);
  const auto cell_at = [&, sin = sin, cos = cos](double x, double y) {
    const double right_m = cos * (x - origin.x) + sin * (y - origin.y);
    const double up_m = cos * (y - origin.y) - sin * (x - origin.x);
    const int column = static_cast<int>(std::floor(right_m / resolution_m));
    const int row = static_cast<int>(std::floor(up_m / resolution_m));
    const bool is_inside = column >= 0 && row >= 0 && column < cells.width() && row < cells.height();
    return is_inside ? cells.at(column, row) : kUnknown;
  };
  for (int y = 0; y < static_cast<int>(grid.getSizeY()); ++y)
    for (int x = 0; x < static_cast<int>(grid.getSizeX()); ++x) {
      Grid::cellType& cell = grid.getRow(y)[x];
      for (const auto& [right, up] :
           {std::pair{-1, -1}, std::pair{-1, 1}, std::pair{1, -1}, std::pair{1, 1}}) {
        const Grid::cellType found = cell_at(static_cast<double>(grid.idx2x(x)) + right * resolution_m / 4,
                                             static_cast<double>(grid.idx2y(y)) + up * resolution_m / 4);
        cell = cell == kUnknown ? found : found == kUnknown ? cell : std::min(cell, found);
      }
    }
}

}  // namespace

MapServerFile read_map_server_file(const std::filesystem::path& path) {
  const MapKeys keys(path);
  MapServerFile file;
  file.image = path.parent_path() / keys.text("image");  // an absolute image replaces the parent
  file.resolution_m = keys.number("resolution");
  file.map_T_image = origin_of(keys);
  file.negate = is_true(keys, "negate");
  file.occupied_threshold = keys.number("occupied_thresh");
  file.free_threshold = keys.number("free_thresh");
  if (file.free_threshold < 0 || file.free_threshold >= file.occupied_threshold ||
      file.occupied_threshold > 1)
    keys.fail("occupied_thresh", "a number above free_thresh, and both from 0 to 1");
  file.mode = mode_of(keys);
  return file;
}

GridCorners corners_of_grid(const MapServerFile& file, const ImageSize& size) {
  const TPose2D& origin = file.map_T_image;
  const double width_m = static_cast<double>(size.width) * file.resolution_m;
  const double height_m = static_cast<double>(size.height) * file.resolution_m;
  if (origin.phi == 0) return {{origin.x, origin.y}, {origin.x + width_m, origin.y + height_m}};
  GridCorners corners{{origin.x, origin.y}, {origin.x, origin.y}};
  auto& [low, high] = corners;
  for (const TPose2D& corner :
       {TPose2D(width_m, 0, 0), TPose2D(0, height_m, 0), TPose2D(width_m, height_m, 0)}) {
    const TPose2D place = compose(origin, corner);
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  const mrpt::math::TPoint2D margin(file.resolution_m, file.resolution_m);
  return {low - margin, high + margin};
}

std::optional<Grid> grid_of_image(const MapServerFile& file) {
  const std::optional<cv::Mat> image = decoded(file.image);
  if (!image) return std::nullopt;
  const ImageCells cells(file, *image);
  const auto& [low, high] = corners_of_grid(
      file, {static_cast<std::uint64_t>(cells.width()), static_cast<std::uint64_t>(cells.height())});
  Grid grid;
  grid.setSize(static_cast<float>(low.x), static_cast<float>(high.x), static_cast<float>(low.y),
               static_cast<float>(high.y), static_cast<float>(file.resolution_m), 0.5F);
  if (file.map_T_image.phi != 0) {
    draw_turned(file, cells, grid);
    return grid;
  }
  const int rows = std::min(static_cast<int>(grid.getSizeY()), cells.height());
  const int columns = std::min(static_cast<int>(grid.getSizeX()), cells.width());
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) grid.getRow(row)[column] = cells.at(column, row);
  return grid;
}

}  // namespace psi_slam
