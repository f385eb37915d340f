// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/change_picture.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "map/rendering/picture_ink.h"
#include "map/rendering/png_bytes.h"

namespace psi_slam {
namespace {

constexpr int kLeastSide_px = 1200;
constexpr int kMostSide_px = 6000;
constexpr int kMargin_cells = 10;

// Colours that people with any kind of colour vision can tell apart (Okabe and Ito 2008).
const Pixel kAppearedInk{178, 114, 0, 255};
const Pixel kVanishedInk{0, 94, 213, 255};
const Pixel kMovedInk{167, 121, 204, 255};
const Pixel kWallOfOneInk{170, 160, 150, 255};

const Pixel& ink_of(ComparedCell cell) {
  switch (cell) {
    case ComparedCell::kUnknown:
      return kUnknownInk;
    case ComparedCell::kFree:
      return kFreeInk;
    case ComparedCell::kWall:
      return kWallInk;
    case ComparedCell::kWallOfOne:
      return kWallOfOneInk;
    case ComparedCell::kAppeared:
      return kAppearedInk;
    case ComparedCell::kVanished:
      return kVanishedInk;
  }
  return kUnknownInk;
}

cv::Scalar colour(const Pixel& ink) {
  return {static_cast<double>(ink[0]), static_cast<double>(ink[1]), static_cast<double>(ink[2])};
}

/// Rectangle around all cells that a map shows, with a margin, as columns and rows of the cells.
cv::Rect shown_cells(const ComparedCells& cells) {
  cv::Rect shown;
  for (int y = 0; y < cells.height; ++y)
    for (int x = 0; x < cells.width; ++x)
      if (cells.at(x, y) != ComparedCell::kUnknown) shown |= cv::Rect(x, y, 1, 1);
  return {shown.x - kMargin_cells, shown.y - kMargin_cells, shown.width + 2 * kMargin_cells,
          shown.height + 2 * kMargin_cells};
}

/// A picture of the cells in `shown`, `pixels` pixels for each cell; row 0 is the top.
class Picture {
 public:
  Picture(const ComparedCells& cells, const cv::Rect& shown)
      : cells_(cells), shown_(shown), image_(shown.height, shown.width, CV_8UC3, colour(kUnknownInk)) {
    for (int row = 0; row < shown.height; ++row) {
      for (int column = 0; column < shown.width; ++column) {
        const int x = shown.x + column;
        const int y = shown.y + shown.height - 1 - row;
        if (x < 0 || x >= cells.width || y < 0 || y >= cells.height) continue;
        const Pixel& ink = ink_of(cells.at(x, y));
        image_.at<cv::Vec3b>(row, column) = {ink[0], ink[1], ink[2]};
      }
    }
    const int longer = std::max(shown.width, shown.height);
    scale_ = longer > kMostSide_px ? static_cast<double>(kMostSide_px) / longer
                                   : std::ceil(static_cast<double>(kLeastSide_px) / longer);
    cv::resize(image_, image_, {}, scale_, scale_, scale_ < 1 ? cv::INTER_AREA : cv::INTER_NEAREST);
    unit_ = std::max(6, std::max(image_.cols, image_.rows) / 160);
  }

  /// Draws a ring around the change, and for a moved wall an arrow to its new place.
  void mark(const WallChange& change) {
    const cv::Point2d from = pixel(change.middle());
    const cv::Point2d to = pixel(change.middle() + change.shift);
    const double radius_m = 0.5 * (change.length_m + change.shift.norm());
    const Pixel& ink = change.kind == WallChange::Kind::kAppeared   ? kAppearedInk
                       : change.kind == WallChange::Kind::kVanished ? kVanishedInk
                                                                    : kMovedInk;
    const int radius = static_cast<int>(radius_m / cells_.cell_m * scale_) + 2 * unit_;
    const int thick = std::max(1, unit_ / 4);
    cv::circle(image_, 0.5 * (from + to), radius, colour(ink), thick, cv::LINE_AA);
    if (change.kind == WallChange::Kind::kMoved)
      cv::arrowedLine(image_, from, to, colour(ink), thick, cv::LINE_AA, 0, 0.3);
  }

  void add_legend() {
    const int top = image_.rows;
    cv::copyMakeBorder(image_, image_, 0, 5 * unit_, 0, std::max(0, 110 * unit_ - image_.cols),
                       cv::BORDER_CONSTANT, colour(kUnknownInk));
    const double pixel_m = cells_.cell_m / scale_;
    const int middle = top + 5 * unit_ / 2;
    const double bar_m = scale_bar_m(image_.cols * pixel_m / 2, pixel_m);
    draw_scale_bar(image_, {2 * unit_, middle, unit_}, bar_m, pixel_m);
    int left = 2 * unit_ + static_cast<int>(bar_m / pixel_m) + 9 * unit_;
    const std::pair<const char*, const Pixel&> entries[] = {{"appeared", kAppearedInk},
                                                            {"vanished", kVanishedInk},
                                                            {"moved", kMovedInk},
                                                            {"in both maps", kWallInk},
                                                            {"other map shows too little", kWallOfOneInk}};
    for (const auto& [text, ink] : entries) {
      cv::rectangle(image_, {left, middle - unit_ / 2, unit_, unit_}, colour(ink), cv::FILLED);
      const double font_scale = unit_ / 18.0;
      const int thick = std::max(1, unit_ / 10);
      cv::putText(image_, text, {left + 3 * unit_ / 2, middle + unit_ / 2}, cv::FONT_HERSHEY_DUPLEX,
                  font_scale, colour(kWallInk), thick, cv::LINE_AA);
      left += cv::getTextSize(text, cv::FONT_HERSHEY_DUPLEX, font_scale, thick, nullptr).width + 4 * unit_;
    }
  }

  cv::Mat take_image() { return std::move(image_); }

 private:
  cv::Point2d pixel(const mrpt::math::TPoint2D& point) const {
    const double x = (point.x - cells_.x_min_m) / cells_.cell_m - shown_.x;
    const double y = (point.y - cells_.y_min_m) / cells_.cell_m - shown_.y;
    return {x * scale_, (shown_.height - y) * scale_};
  }

  const ComparedCells& cells_;
  cv::Rect shown_;
  cv::Mat image_;
  double scale_ = 1;
  int unit_ = 6;
};

}  // namespace

std::string change_picture(const WallChanges& walls) {
  Picture picture(walls.cells, shown_cells(walls.cells));
  for (const WallChange& change : walls.changes) picture.mark(change);
  picture.add_legend();
  return png_bytes(picture.take_image());
}

}  // namespace psi_slam
