// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/traffic.h"

#include <algorithm>
#include <cmath>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "simulation/simulation_random.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

constexpr double kCartLength_m = 0.9;
constexpr double kCartWidth_m = 0.5;
constexpr double kCartToWall_m = 0.25;
constexpr double kAway_m = 1.5;  // things keep this distance from the robot
constexpr double kOperatorAhead_m = 0.5;
constexpr double kOperatorAside_m = 0.65;
constexpr double kStride_m = 0.15;
constexpr double kStridesPer_s = 0.9;

/// Outline of a cart that stands along a wall of a corridor.
std::vector<PlanSegment> cart_outline(const Corridor& corridor, SimulationRandom& random) {
  const TPoint2D way = corridor.to - corridor.from;
  const double length_m = portable::hypot(way.x, way.y);
  const TPoint2D along = way * (1 / length_m);
  const TPoint2D across(-along.y, along.x);
  const double from_m = random.between(0.1, 0.9) * (length_m - kCartLength_m);
  const double side = random.happens(0.5) ? 1 : -1;
  const double outer_m = side * (corridor.width_m / 2 - kCartToWall_m);
  const double inner_m = outer_m - side * kCartWidth_m;
  const auto corner = [&](double along_m, double across_m) {
    return corridor.from + along * along_m + across * across_m;
  };
  const std::vector<TPoint2D> corners{corner(from_m, outer_m), corner(from_m + kCartLength_m, outer_m),
                                      corner(from_m + kCartLength_m, inner_m), corner(from_m, inner_m)};
  std::vector<PlanSegment> outline;
  for (std::size_t i = 0; i < corners.size(); ++i)
    outline.push_back({corners[i], corners[(i + 1) % corners.size()], Material::kFurniture});
  return outline;
}

}  // namespace

Traffic::Traffic(const FloorPlan& plan, const TrafficOptions& options)
    : options_(options), people_(plan, options.people, options.seed) {
  SimulationRandom random(options.seed, SimulationRandom::Stream::kPeople, 1);
  for (std::size_t i = 0; i < options.carts; ++i) {
    const Corridor& corridor = plan.corridors[random.index(plan.corridors.size())];
    things_.push_back({cart_outline(corridor, random), i % 2 == 0});
  }
  if (!options.doors) return;
  for (const PlanSegment& door : plan.doors) things_.push_back({{door}, random.happens(0.5)});
}

TrafficNow Traffic::at(double time_s, const TPose2D& world_T_robot) const {
  TrafficNow now;
  now.people = people_.at(time_s);
  for (const Thing& thing : things_) {
    const bool is_near =
        std::any_of(thing.outline.begin(), thing.outline.end(), [&](const PlanSegment& side) {
          const TPoint2D middle = (side.from + side.to) * 0.5;
          return distance_m(world_T_robot, middle) < kAway_m;
        });
    const bool is_there =
        thing.leaves ? time_s < 0.75 * options_.duration_s : time_s > 0.25 * options_.duration_s;
    if (is_there && !is_near) now.things.insert(now.things.end(), thing.outline.begin(), thing.outline.end());
  }
  const double stride_m = kStride_m * portable::sin(2 * M_PI * kStridesPer_s * time_s);
  if (options_.has_operator)
    now.people.push_back(transform(world_T_robot, {kOperatorAhead_m + stride_m, kOperatorAside_m}));
  return now;
}

}  // namespace psi_slam
