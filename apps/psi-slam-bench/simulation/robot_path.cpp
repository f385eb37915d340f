// SPDX-License-Identifier: BSD-3-Clause
#include "simulation/robot_path.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "simulation/simulation_random.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;

constexpr double kAhead_m = 0.5;  // distance from the robot to the carrot, the point that it follows
constexpr double kCarrotStep_m = 0.01;
constexpr double kStep_s = 0.0125;
constexpr double kTurnPerError = 2.5;  // rad/s per radian between the heading and the direction of the carrot
constexpr double kTurnOnTheSpot_rad = 1.0;

// Costs of taking a passage. Each earlier use in the same direction costs 1.
constexpr double kTakenTheOtherWay = 0.4;  // cost of each use in the opposite direction
constexpr double kTurningBack = 3.0;
constexpr double kPassedDoors = 0.6;  // probability that a door has the cost kEnteringRoom
constexpr double kEnteringRoom = 2.0;

/// An endless route over the places of a floor plan. It prefers the passages that it has used least. It
/// therefore visits all places, closes rings and uses corridors in both directions.
class Route {
 public:
  /// Starts at a crossing. The plan must outlive the route.
  Route(const FloorPlan& plan, std::uint64_t seed)
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

  std::size_t here() const { return here_; }

  /// Moves along a passage to the next place and returns the index of the place.
  std::size_t next() {
    std::vector<Way>& ways = ways_[here_];
    std::vector<double> reluctances;
    for (const Way& way : ways) reluctances.push_back(reluctance(way));
    Way& way = ways[static_cast<std::size_t>(std::min_element(reluctances.begin(), reluctances.end()) -
                                             reluctances.begin())];
    ++way.taken;
    before_ = here_;
    return here_ = way.to;
  }

 private:
  struct Way {
    std::size_t to = 0;
    std::size_t back = 0;  ///< index of the opposite direction in the ways from `to`
    double taken = 0;      ///< number of uses
  };

  double reluctance(const Way& way) {
    double reluctance = way.taken + kTakenTheOtherWay * ways_[way.to][way.back].taken + 0.3 * random_.share();
    const bool into_room = plan_.places[way.to].kind == Place::Kind::kRoom;
    if (into_room && random_.happens(kPassedDoors)) reluctance += kEnteringRoom;
    if (way.to == before_) reluctance += kTurningBack;
    return reluctance;
  }

  const FloorPlan& plan_;
  SimulationRandom random_;
  std::vector<std::vector<Way>> ways_;  ///< ways from each place
  std::size_t here_ = 0;
  std::size_t before_ = 0;
};

}  // namespace

/// The point that the robot follows. It moves along the lines between places with small sideways deviations.
class RobotPath::Carrot {
 public:
  Carrot(const FloorPlan& plan, const RobotPathOptions& options)
      : plan_(plan), route_(plan, options.seed), weave_m_(options.weave_m) {
    SimulationRandom random(options.seed, SimulationRandom::Stream::kRoute, 1);
    for (double& phase : phases_) phase = random.between(0, 2 * M_PI);
    from_ = plan_.places[route_.here()].at;
    to_ = plan_.places[route_.next()].at;
  }

  void run_ahead_of(const TPoint2D& robot) {
    while (distance_m(at(), robot) < kAhead_m) {
      along_m_ += kCarrotStep_m;
      run_m_ += kCarrotStep_m;
      while (along_m_ > distance_m(from_, to_)) {
        along_m_ -= distance_m(from_, to_);
        from_ = to_;
        to_ = plan_.places[route_.next()].at;
      }
    }
  }

  TPoint2D at() const {
    const double length = std::max(distance_m(from_, to_), 1e-9);
    const double x = (to_.x - from_.x) / length;
    const double y = (to_.y - from_.y) / length;
    const double aside =
        weave_m_ / 2 * (portable::sin(run_m_ / 3.1 + phases_[0]) + portable::sin(run_m_ / 1.3 + phases_[1]));
    return {from_.x + along_m_ * x - aside * y, from_.y + along_m_ * y + aside * x};
  }

 private:
  const FloorPlan& plan_;
  Route route_;
  double weave_m_;
  double phases_[2] = {0, 0};
  TPoint2D from_;
  TPoint2D to_;
  double along_m_ = 0;  ///< distance from from_ towards to_
  double run_m_ = 0;    ///< total distance along the route
};

RobotPath::RobotPath(const FloorPlan& plan, const RobotPathOptions& options)
    : options_(options), carrot_(std::make_unique<Carrot>(plan, options)) {
  const TPoint2D start = carrot_->at();
  carrot_->run_ahead_of(start);
  const TPoint2D ahead = carrot_->at();
  now_.world_T_robot = {start.x, start.y, portable::atan2(ahead.y - start.y, ahead.x - start.x)};
}

RobotPath::~RobotPath() = default;
RobotPath::RobotPath(RobotPath&&) noexcept = default;

std::optional<PathPose> RobotPath::next() {
  if (started_) {
    if (now_.travelled_m >= options_.path_m) return std::nullopt;
    const double period_s = 1 / options_.scan_rate_hz;
    const int steps = std::max(1, static_cast<int>(std::lround(period_s / kStep_s)));
    for (int step = 0; step < steps; ++step) advance(period_s / steps);
  }
  started_ = true;
  return now_;
}

void RobotPath::advance(double duration_s) {
  mrpt::math::TPose2D& pose = now_.world_T_robot;
  carrot_->run_ahead_of({pose.x, pose.y});
  const TPoint2D ahead = carrot_->at();
  const double off = std::remainder(portable::atan2(ahead.y - pose.y, ahead.x - pose.x) - pose.phi, 2 * M_PI);
  const double turn = std::clamp(kTurnPerError * off, -options_.max_turn_rad_s, options_.max_turn_rad_s);
  const double wanted =
      std::abs(off) > kTurnOnTheSpot_rad ? 0 : options_.max_speed_m_s * portable::pow(portable::cos(off), 4);
  const double change = options_.max_acceleration_m_s2 * duration_s;
  speed_m_s_ = std::clamp(wanted, std::max(0.0, speed_m_s_ - 3 * change), speed_m_s_ + change);
  const double way_m = speed_m_s_ * duration_s;
  const double heading = pose.phi + turn * duration_s / 2;
  pose = {pose.x + way_m * portable::cos(heading), pose.y + way_m * portable::sin(heading),
          std::remainder(pose.phi + turn * duration_s, 2 * M_PI)};
  now_.travelled_m += way_m;
  now_.time_s += duration_s;
}

}  // namespace psi_slam
