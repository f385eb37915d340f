// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/beam_directions.h"

#include <array>
#include <cstddef>
#include <utility>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

constexpr std::size_t kLasers = 8;

struct Laser {
  BeamBearings bearings_rad;
  BeamDirections directions;
};

BeamDirections directions_of(const std::vector<float>& bearings_rad) {
  std::vector<mrpt::math::TPoint2D> directions;
  directions.reserve(bearings_rad.size());
  for (const float bearing_rad : bearings_rad) {
    const auto angle_rad = static_cast<double>(bearing_rad);
    directions.emplace_back(portable::cos(angle_rad), portable::sin(angle_rad));
  }
  return std::make_shared<const std::vector<mrpt::math::TPoint2D>>(std::move(directions));
}

}  // namespace

BeamDirections beam_directions(const BeamBearings& bearings_rad) {
  if (!bearings_rad) return directions_of({});
  thread_local std::array<Laser, kLasers> lasers;
  thread_local std::size_t next = 0;
  for (const Laser& laser : lasers)
    if (laser.bearings_rad == bearings_rad) return laser.directions;
  next = (next + 1) % kLasers;
  lasers[next] = {bearings_rad, directions_of(*bearings_rad)};
  return lasers[next].directions;
}

}  // namespace psi_slam
