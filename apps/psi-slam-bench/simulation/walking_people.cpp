// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/walking_people.h"

#include <algorithm>
#include <cmath>

#include "simulation/simulation_random.h"

namespace psi_slam {
namespace {

constexpr double kSlowest_m_s = 0.7;
constexpr double kFastest_m_s = 1.5;
constexpr double kFromWall_m = 0.3;  // between the wall and a person

}  // namespace

WalkingPeople::WalkingPeople(const FloorPlan& plan, std::size_t count, std::uint64_t seed) {
  SimulationRandom random(seed, SimulationRandom::Stream::kPeople);
  for (std::size_t i = 0; i < count; ++i) {
    const Corridor& corridor = plan.corridors[random.index(plan.corridors.size())];
    const mrpt::math::TPoint2D way = corridor.to - corridor.from;
    const double length = std::hypot(way.x, way.y);
    const double aside =
        random.between(-1, 1) * std::max(0.0, corridor.width_m / 2 - kFromWall_m - kPersonRadius_m);
    const mrpt::math::TPoint2D off(-aside * way.y / length, aside * way.x / length);
    const double speed = random.between(kSlowest_m_s, kFastest_m_s);
    people_.push_back({corridor.from + off, corridor.to + off, speed, random.between(0, 2 * length)});
  }
}

std::vector<mrpt::math::TPoint2D> WalkingPeople::at(double time_s) const {
  std::vector<mrpt::math::TPoint2D> points;
  for (const Person& person : people_) {
    const mrpt::math::TPoint2D way = person.to - person.from;
    const double length = std::hypot(way.x, way.y);
    const double gone = std::fmod(person.start_m + person.speed_m_s * time_s, 2 * length);
    const double share = std::min(gone, 2 * length - gone) / length;
    points.push_back(person.from + way * share);
  }
  return points;
}

}  // namespace psi_slam
