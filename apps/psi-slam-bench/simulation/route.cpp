// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/route.h"

#include <algorithm>

namespace psi_slam {
namespace {

constexpr double kTakenTheOtherWay = 0.4;  // weight of a passage taken in the opposite direction
constexpr double kTurningBack = 3.0;
constexpr double kPassedDoors = 0.6;  // share of the doors that the robot does not enter
constexpr double kEnteringRoom = 2.0;

}  // namespace

Route::Route(const FloorPlan& plan, std::uint64_t seed)
    : plan_(plan), random_(seed, SimulationRandom::Stream::kRoute), ways_(plan.places.size()) {
  for (const Passage& passage : plan.passages) {
    std::vector<Way>& from = ways_[passage.from];
    std::vector<Way>& to = ways_[passage.to];
    from.push_back({passage.to, to.size(), 0});
    to.push_back({passage.from, from.size() - 1, 0});
  }
  while (plan.places[here_].kind != Place::Kind::kCrossing) ++here_;
  before_ = here_;
}

double Route::reluctance(const Way& way) {
  double reluctance = way.taken + kTakenTheOtherWay * ways_[way.to][way.back].taken + 0.3 * random_.share();
  const bool into_room = plan_.places[way.to].kind == Place::Kind::kRoom;
  if (into_room && random_.happens(kPassedDoors)) reluctance += kEnteringRoom;
  if (way.to == before_) reluctance += kTurningBack;
  return reluctance;
}

std::size_t Route::next() {
  if (!started_) {
    started_ = true;
    return here_;
  }
  std::vector<Way>& ways = ways_[here_];
  std::vector<double> reluctances;
  for (const Way& way : ways) reluctances.push_back(reluctance(way));
  Way& way = ways[static_cast<std::size_t>(std::min_element(reluctances.begin(), reluctances.end()) -
                                           reluctances.begin())];
  ++way.taken;
  before_ = here_;
  here_ = way.to;
  return here_;
}

}  // namespace psi_slam
