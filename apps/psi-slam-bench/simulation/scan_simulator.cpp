// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/scan_simulator.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "base/portable_math.h"
#include "logs/frames/laser_readings.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kRepaintAfter_m = 8;

// Values of the cells, and the least values that beams pass: with kStopAtGlass, a beam ends at glass.
constexpr float kFree = 1.0F;
constexpr float kGlass = 0.7F;
constexpr float kSolid = 0.0F;
constexpr float kStopAtGlass = 0.85F;
constexpr float kPassGlass = 0.35F;

/// Distance along the ray to a circle, in metres. Infinite if the ray misses the circle, or starts inside,
/// because people step aside for the robot.
double range_to_circle_m(const TPose2D& ray, const TPoint2D& middle, double radius_m) {
  const double x = middle.x - ray.x;
  const double y = middle.y - ray.y;
  const double along = x * portable::cos(ray.phi) + y * portable::sin(ray.phi);
  const double aside2 = x * x + y * y - along * along;
  const double half2 = radius_m * radius_m - aside2;
  if (half2 < 0 || x * x + y * y <= radius_m * radius_m || along <= 0)
    return std::numeric_limits<double>::infinity();
  return along - std::sqrt(half2);
}

/// Distance along the ray to a segment, in metres. Infinite if the ray misses the segment.
double range_to_segment_m(const TPose2D& ray, const PlanSegment& segment) {
  const TPoint2D direction(portable::cos(ray.phi), portable::sin(ray.phi));
  const TPoint2D way = segment.to - segment.from;
  const TPoint2D off = segment.from - TPoint2D(ray.x, ray.y);
  const double determinant = direction.x * way.y - direction.y * way.x;
  const double range = (off.x * way.y - off.y * way.x) / determinant;
  const double share = (off.x * direction.y - off.y * direction.x) / determinant;
  const bool meets = std::abs(determinant) > 1e-12 && range > 0 && share >= 0 && share <= 1;
  return meets ? range : std::numeric_limits<double>::infinity();
}

BeamBearings even_bearings(std::size_t beams, double field_of_view_rad) {
  std::vector<float> bearings(beams);
  for (std::size_t i = 0; i < beams; ++i)
    bearings[i] = static_cast<float>(field_of_view_rad *
                                     (static_cast<double>(i) / static_cast<double>(beams - 1) - 0.5));
  return std::make_shared<const std::vector<float>>(std::move(bearings));
}

bool is_share(double value) {
  return value >= 0 && value <= 1;
}

void check(const ScanSimulatorOptions& options) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw std::invalid_argument(std::string("ScanSimulator: ") + what);
  };
  const TPose2D& mount = options.robot_T_laser;
  require(options.beams >= 2, "fewer than two beams");
  require(options.field_of_view_rad > 0 && options.field_of_view_rad <= 2 * M_PI,
          "the field of view is not in (0, 2 pi]");
  require(options.resolution_m > 0, "the resolution is not positive");
  require(options.max_range_m > options.resolution_m && std::isfinite(options.max_range_m),
          "the range is not above the resolution, or is infinite");
  require(std::isfinite(mount.x) && std::isfinite(mount.y) && std::isfinite(mount.phi),
          "the pose of the laser is not finite");
  require(options.noise_m >= 0 && std::isfinite(options.noise_m), "the noise is negative or infinite");
  require(is_share(options.dropout_share), "the share of dropouts is not in [0, 1]");
  require(options.glass_return_share >= 0 && options.glass_loss_share >= 0 &&
              is_share(options.glass_return_share + options.glass_loss_share),
          "the shares at glass are negative, or above 1 in total");
}

}  // namespace

ScanSimulator::ScanSimulator(const FloorPlan& plan, const ScanSimulatorOptions& options)
    : plan_(plan), options_(options) {
  check(options);
  bearings_rad_ = even_bearings(options.beams, options.field_of_view_rad);
}

void ScanSimulator::paint_around(const TPoint2D& middle) {
  const float half = static_cast<float>(options_.max_range_m + kRepaintAfter_m + 1);
  const auto x = static_cast<float>(middle.x);
  const auto y = static_cast<float>(middle.y);
  grid_.setSize(x - half, x + half, y - half, y + half, static_cast<float>(options_.resolution_m), kFree);
  any_glass_ = false;
  for (const bool glass : {true, false})  // solid cells replace glass
    for (const PlanSegment& segment : plan_.segments)
      if ((segment.material == Material::kGlass) == glass) paint(segment);
  painted_ = middle;
  any_painted_ = true;
}

// Paints every cell that the segment crosses, so that no beam passes between diagonal cells.
void ScanSimulator::paint(const PlanSegment& segment) {
  const auto cell_m = static_cast<double>(grid_.getResolution());
  const double x0 = (segment.from.x - static_cast<double>(grid_.getXMin())) / cell_m;
  const double y0 = (segment.from.y - static_cast<double>(grid_.getYMin())) / cell_m;
  const double dx = (segment.to.x - segment.from.x) / cell_m;
  const double dy = (segment.to.y - segment.from.y) / cell_m;
  const auto size_x = static_cast<double>(grid_.getSizeX());
  const auto size_y = static_cast<double>(grid_.getSizeY());
  if (std::max(x0, x0 + dx) < 0 || std::min(x0, x0 + dx) >= size_x || std::max(y0, y0 + dy) < 0 ||
      std::min(y0, y0 + dy) >= size_y)
    return;
  const bool glass = segment.material == Material::kGlass;
  any_glass_ = any_glass_ || glass;
  int x = static_cast<int>(std::floor(x0));
  int y = static_cast<int>(std::floor(y0));
  const int x_end = static_cast<int>(std::floor(x0 + dx));
  const int y_end = static_cast<int>(std::floor(y0 + dy));
  const double infinity = std::numeric_limits<double>::infinity();
  // Parameters of the segment, 0 at its start and 1 at its end, where it enters the next column and row.
  double next_x = dx == 0 ? infinity : ((dx > 0 ? x + 1 : x) - x0) / dx;
  double next_y = dy == 0 ? infinity : ((dy > 0 ? y + 1 : y) - y0) / dy;
  for (int steps = std::abs(x_end - x) + std::abs(y_end - y); steps >= 0; --steps) {
    grid_.setCell(x, y, glass ? kGlass : kSolid);
    if (next_x < next_y) {
      x += dx > 0 ? 1 : -1;
      next_x += std::abs(1 / dx);
    } else {
      y += dy > 0 ? 1 : -1;
      next_y += std::abs(1 / dy);
    }
  }
}

double ScanSimulator::range_m(const TPose2D& ray, float least_free) const {
  float range = 0;
  bool valid = false;
  // MRPT takes the maximum range as a number of steps, as if each step had the length of a cell.
  const double steps_m =
      options_.max_range_m / mrpt::maps::COccupancyGridMap2D::RAYTRACE_STEP_SIZE_IN_CELL_UNITS;
  grid_.simulateScanRay(ray.x, ray.y, ray.phi, range, valid, steps_m, least_free);
  return valid ? static_cast<double>(range) : std::numeric_limits<double>::infinity();
}

// Range in the plan without people. A beam that meets glass returns, is lost or passes, at random.
double ScanSimulator::plan_range_m(const TPose2D& ray, SimulationRandom& random) const {
  const double behind_m = range_m(ray, kPassGlass);
  if (!any_glass_) return behind_m;
  const double chance = random.share();
  const double glass_m = range_m(ray, kStopAtGlass);
  if (glass_m >= behind_m || chance < options_.glass_return_share) return glass_m;
  if (chance < options_.glass_return_share + options_.glass_loss_share)
    return std::numeric_limits<double>::infinity();
  return behind_m;
}

LaserScan ScanSimulator::scan(const TPose2D& world_T_robot, const std::vector<TPoint2D>& people,
                              std::uint64_t index, const std::vector<PlanSegment>& things) {
  const TPose2D world_T_laser = compose(world_T_robot, options_.robot_T_laser);
  const TPoint2D here(world_T_laser.x, world_T_laser.y);
  if (!any_painted_ ||
      std::max(std::abs(here.x - painted_.x), std::abs(here.y - painted_.y)) > kRepaintAfter_m)
    paint_around(here);
  SimulationRandom random(options_.seed, SimulationRandom::Stream::kScan, index);
  LaserScan scan;
  scan.bearings_rad = bearings_rad_;
  scan.max_range_m = static_cast<float>(options_.max_range_m);
  scan.robot_T_laser = options_.robot_T_laser;
  for (const float bearing : *bearings_rad_) {
    const TPose2D ray(here.x, here.y, world_T_laser.phi + static_cast<double>(bearing));
    double range = plan_range_m(ray, random);
    for (const TPoint2D& person : people)
      range = std::min(range, range_to_circle_m(ray, person, kPersonRadius_m));
    for (const PlanSegment& thing : things) range = std::min(range, range_to_segment_m(ray, thing));
    range += options_.noise_m * random.normal();
    if (random.happens(options_.dropout_share)) range = std::numeric_limits<double>::infinity();
    scan.ranges_m.push_back(static_cast<float>(range));
  }
  mark_no_returns(scan.ranges_m, 0, options_.max_range_m);
  return scan;
}

}  // namespace psi_slam
