// SPDX-License-Identifier: BSD-3-Clause
// Renders scenes with OpenGL, without a window.
#include <gmock/gmock.h>
#include <mrpt/opengl/CFBORender.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <vector>

#include "gui/map_camera.h"
#include "gui/map_scene.h"
#include "gui/palette.h"
#include "replayed_room.h"

namespace psi_slam {
namespace {

const mrpt::img::TImageSize kPictureSize(1104, 536);

class MapRenderingTest : public ReplayedRoom {
 protected:
  static void SetUpTestSuite() {
    setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
    ReplayedRoom::SetUpTestSuite();
  }
  void SetUp() override {
    try {
      renderer_ = std::make_unique<mrpt::opengl::CFBORender>(kPictureSize.x, kPictureSize.y);
    } catch (const std::exception& error) {
      GTEST_SKIP() << "needs OpenGL: " << error.what();
    }
    scene_ = std::make_unique<MapScene>();
    camera_ = camera_above(map_->raster.rectangle(), kPictureSize);
  }

  /// Renders these layers over the grid map, seen from above.
  void draw(std::initializer_list<MapLayer> layers) {
    for (std::size_t i = 0; i < kMapLayers; ++i) scene_->set_visible(static_cast<MapLayer>(i), false);
    scene_->set_visible(MapLayer::kGrid, true);
    for (const MapLayer layer : layers) scene_->set_visible(layer, true);
    scene_->show(finished_, drawn_);
    scene_->set_clip_distances(camera_.distance_m / 5, camera_.distance_m * 8);
    mrpt::opengl::CCamera eye;
    eye.setPointingAt(static_cast<float>(camera_.target.x), static_cast<float>(camera_.target.y), 0.0F);
    eye.setZoomDistance(static_cast<float>(camera_.distance_m));
    eye.setAzimuthDegrees(-90);
    eye.setElevationDegrees(89.9F);
    eye.setProjectiveFOVdeg(static_cast<float>(camera_.field_of_view_deg));
    renderer_->setCamera(*scene_->scene(), eye);
    renderer_->render_RGB(*scene_->scene(), picture_);
  }

  /// True if a pixel within 2 px of the place, given in the map frame, has about this colour.
  bool seen(const mrpt::math::TPoint2D& place, const mrpt::img::TColor& colour) const {
    const auto middle = ground_at(camera_, kPictureSize, kPictureSize.x / 2.0, kPictureSize.y / 2.0);
    const auto beside = ground_at(camera_, kPictureSize, kPictureSize.x / 2.0 + 100, kPictureSize.y / 2.0);
    const double px_per_m = 100 / (beside->x - middle->x);
    const int x = static_cast<int>(std::lround(kPictureSize.x / 2.0 + (place.x - middle->x) * px_per_m));
    const int y = static_cast<int>(std::lround(kPictureSize.y / 2.0 - (place.y - middle->y) * px_per_m));
    const auto near = [](std::uint8_t a, std::uint8_t b) { return std::abs(int{a} - int{b}) < 70; };
    for (int row = y - 2; row <= y + 2; ++row)
      for (int column = x - 2; column <= x + 2; ++column) {
        const auto channel = [&](std::int8_t index) {
          return picture_.at<std::uint8_t>(static_cast<unsigned>(column), static_cast<unsigned>(row), index);
        };
        if (near(channel(2), colour.R) && near(channel(1), colour.G) && near(channel(0), colour.B))
          return true;
      }
    return false;
  }
  /// Green of all pixels, row by row.
  std::vector<std::uint8_t> greens() const {
    std::vector<std::uint8_t> greens;
    for (unsigned y = 0; y < static_cast<unsigned>(kPictureSize.y); ++y)
      for (unsigned x = 0; x < static_cast<unsigned>(kPictureSize.x); ++x)
        greens.push_back(picture_.at<std::uint8_t>(x, y, 1));
    return greens;
  }
  /// Share of the nodes at which the colour is seen, in [0, 1].
  double share_seen(const mrpt::img::TColor& colour) const {
    const auto& nodes = *finished_->map_T_node;
    const auto count = std::count_if(nodes.begin(), nodes.end(), [&](const auto& node) {
      return seen({node.x, node.y}, colour);
    });
    return static_cast<double>(count) / static_cast<double>(nodes.size());
  }

  // Must outlive the scene, whose objects belong to its OpenGL context.
  std::unique_ptr<mrpt::opengl::CFBORender> renderer_;
  std::unique_ptr<MapScene> scene_;
  MapCamera camera_;
  std::shared_ptr<const DrawnMap> drawn_ = map_;
  mrpt::img::CImage picture_;
};

TEST_F(MapRenderingTest, the_grid_map_hides_no_layer_above_it) {
  draw({MapLayer::kTrajectory});
  EXPECT_GT(share_seen(palette::kCorrected), 0.95) << "a thin line may fall between pixels";
  draw({MapLayer::kOdometry});
  EXPECT_EQ(share_seen(palette::kCorrected), 0) << "the path is not drawn";
}

TEST_F(MapRenderingTest, ellipses_show_the_uncertainty_along_the_path) {
  draw({});
  const std::vector<std::uint8_t> without = greens();
  draw({MapLayer::kUncertainty});
  const std::vector<std::uint8_t> with = greens();
  int changed = 0;
  for (std::size_t i = 0; i < with.size(); ++i) changed += with[i] == without[i] ? 0 : 1;
  EXPECT_GT(changed, 200) << "ellipses of some pixels stand along the path";
  EXPECT_LT(changed, 5000);
}

TEST_F(MapRenderingTest, zones_tint_the_map_and_keep_out_zones_cover_slow_ones) {
  const mrpt::img::TColor slow(237, 202, 145);
  const mrpt::img::TColor both(219, 128, 100);
  draw({MapLayer::kZones});
  EXPECT_EQ(share_seen(slow), 0);
  auto map = std::make_shared<DrawnMap>(*map_);
  map->zones = {{MapEdit::Kind::kSlow, map_->raster}};
  drawn_ = map;
  draw({MapLayer::kZones});
  EXPECT_EQ(share_seen(slow), 1);
  map = std::make_shared<DrawnMap>(*map);
  map->zones.insert(map->zones.begin(), {MapEdit::Kind::kKeepOut, map_->raster});
  drawn_ = map;
  draw({MapLayer::kZones});
  EXPECT_EQ(share_seen(both), 1);
  draw({});
  EXPECT_EQ(share_seen(both), 0) << "the layer is hidden";
}

TEST_F(MapRenderingTest, nodes_are_drawn_over_lines) {
  draw({MapLayer::kLoops, MapLayer::kConstraints, MapLayer::kNodes});
  EXPECT_EQ(share_seen(palette::kNode), 1);
}

/// A map of free space that a slanting wall of one cell crosses from top to bottom.
std::shared_ptr<const DrawnMap> map_with_slanting_wall() {
  auto map = std::make_shared<DrawnMap>();
  MapRaster& raster = map->raster;
  raster.width_px = 4000;
  raster.height_px = 1900;
  raster.resolution_m = 0.05;
  raster.pixels.assign(std::size_t{4} * 4000 * 1900, 255);
  for (std::size_t row = 0; row < 1900; ++row) {
    const std::size_t column = 500 + row / 7;
    std::fill_n(raster.pixels.begin() + static_cast<std::ptrdiff_t>(4 * (row * 4000 + column)), 3, 20);
  }
  return map;
}

TEST_F(MapRenderingTest, lines_are_twice_as_wide_on_a_desktop_scaled_by_200_percent) {
  // A level line across the middle of the free map, which a person measures, and one that is a draft.
  const auto add_lines = [&] {
    const double x_m = camera_.target.x;
    const double y_m = camera_.target.y;
    scene_->set_measure(Measure{{x_m - 2, y_m + 0.5}, {x_m + 2, y_m + 0.5}});
    scene_->set_draft({{{x_m - 2, y_m - 0.5}, {x_m + 2, y_m - 0.5}}, false, palette::kMeasure});
  };
  const auto changed_rows = [&](const std::vector<std::uint8_t>& with,
                                const std::vector<std::uint8_t>& without, double offset_m) {
    const int width = kPictureSize.x;
    const int middle =
        kPictureSize.y / 2 - static_cast<int>(offset_m / ground_pixel_m(camera_, kPictureSize));
    int rows = 0;
    for (int y = middle - 12; y <= middle + 12; ++y) {
      const auto at = static_cast<std::size_t>(y * width + width / 2 + 5);
      rows += with[at] != without[at] ? 1 : 0;
    }
    return rows;
  };
  drawn_ = map_with_slanting_wall();  // free space where the lines are
  camera_ = camera_above({0, 12, -6, 0}, kPictureSize);
  draw({});
  const std::vector<std::uint8_t> without = greens();
  add_lines();
  draw({});
  const std::vector<std::uint8_t> single = greens();
  scene_->set_pixel_scale(2);
  draw({});
  const std::vector<std::uint8_t> twice = greens();
  for (const double offset_m : {0.5, -0.5}) {
    const int width_px = changed_rows(single, without, offset_m);
    EXPECT_GE(width_px, 2) << offset_m;
    EXPECT_NEAR(changed_rows(twice, without, offset_m), 2 * width_px, 1) << offset_m;
  }
}

TEST_F(MapRenderingTest, walls_of_one_cell_stay_solid_lines_when_zoomed_out) {
  drawn_ = map_with_slanting_wall();
  camera_ = camera_above(drawn_->raster.rectangle(), kPictureSize);
  const auto rows_with_wall = [&] {
    const std::vector<std::uint8_t> all = greens();
    const auto width = static_cast<std::ptrdiff_t>(kPictureSize.x);
    int rows = 0;
    for (std::ptrdiff_t y = 40; y < kPictureSize.y - 40; ++y)
      rows += *std::min_element(all.begin() + y * width, all.begin() + (y + 1) * width) < 60 ? 1 : 0;
    return rows;
  };
  draw({});
  EXPECT_LT(rows_with_wall(), (kPictureSize.y - 80) / 2)
      << "every cell is drawn, so that many fall between pixels";
  scene_->set_ground_pixel(ground_pixel_m(camera_, kPictureSize));
  draw({});
  EXPECT_EQ(rows_with_wall(), kPictureSize.y - 80);
}

}  // namespace
}  // namespace psi_slam
