// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/pair_alignment.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "logs/doctor/jackknife.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

constexpr double kJumpSpeed_m_s = 3.0;
constexpr double kJump_m = 0.4;
const double kJumpSpeed_rad_s = DEG2RAD(150.0);
const double kJump_rad = DEG2RAD(30.0);

}  // namespace

std::vector<AlignedPair> align_pairs(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                     const ScanLibrary& library, const ShareObserver& progress) {
  std::vector<AlignedPair> aligned;
  aligned.reserve(pairs.size());
  for (const FramePair& pair : pairs) {
    if (!have_same_span(library.at(pair.first), library.at(pair.second))) continue;
    const TPose2D by_odometry = odometry_between(marks, pair);
    const AlignableScan reference(library.at(pair.first));
    const AlignableScan scan(library.at(pair.second));
    aligned.push_back({pair, by_odometry, align_scans(reference, scan, by_odometry)});
    if (progress) progress(static_cast<double>(aligned.size()) / static_cast<double>(pairs.size()));
  }
  return aligned;
}

std::vector<ScanTurn> reliable_turns(const std::vector<AlignedPair>& pairs) {
  const double determined_rad = DEG2RAD(0.5);
  std::vector<ScanTurn> turns;
  for (const AlignedPair& pair : pairs) {
    const ScanAlignment& scans = pair.by_scans;
    if (scans.is_reliable() && scans.heading_deviation_rad() < determined_rad)
      turns.push_back({pair.frames, scans.reference_T_scan.phi});
  }
  return turns;
}

std::optional<ScanDelay> remove_scan_delay(std::vector<AlignedPair>& pairs,
                                           const std::vector<FrameMark>& marks) {
  const std::optional<ScanDelay> delay = estimate_scan_delay(marks, reliable_turns(pairs));
  const bool is_delayed = delay && delay->is_significant();
  const std::vector<FrameMark> measured = is_delayed ? with_scan_delay(marks, delay->delay_s) : marks;
  for (AlignedPair& pair : pairs) pair.by_odometry = odometry_between(measured, pair.frames);
  return delay;
}

LostReversals find_lost_reversals(const std::vector<AlignedPair>& pairs, const ScanLibrary& library) {
  constexpr double kLeastMotion_m = 0.12;
  constexpr double kMaxMotion_m = 0.8;  // for a larger motion, the opposite guess is too far off
  constexpr double kDetermined_m = 0.02;
  // Largest cost of a clearly better alignment, as a fraction of the cost with odometry's motion as the
  // guess.
  constexpr double kClearlyBetter = 0.7;
  LostReversals reversals;
  for (const AlignedPair& pair : pairs) {
    const TPose2D& odometry = pair.by_odometry;
    const double way_m = odometry.norm();
    if (way_m < kLeastMotion_m || way_m > kMaxMotion_m) continue;
    const double direction = portable::atan2(odometry.y, odometry.x);
    // Component of the motion by scans along the motion by odometry, divided by the motion by odometry.
    const auto share_along = [&](const ScanAlignment& alignment) {
      const TPose2D& motion = alignment.reference_T_scan;
      return (motion.x * odometry.x + motion.y * odometry.y) / (way_m * way_m);
    };
    const auto went_back = [&](const ScanAlignment& alignment) {
      const double share = share_along(alignment);
      return alignment.is_reliable() && alignment.deviation_along_m(direction) < kDetermined_m &&
             share < -0.4 && share > -2.0;
    };
    const AlignableScan reference(library.at(pair.frames.first));
    const AlignableScan scan(library.at(pair.frames.second));
    const ScanAlignment back = align_scans(reference, scan, TPose2D{-odometry.x, -odometry.y, odometry.phi});
    const bool determined =
        pair.by_scans.deviation_along_m(direction) < kDetermined_m && pair.by_scans.is_reliable();
    if (!determined && !went_back(back)) continue;
    reversals.checked_m += way_m;
    const bool both_say_so = went_back(pair.by_scans) && went_back(back);
    const bool better = went_back(back) && back.cost_m < kClearlyBetter * pair.by_scans.cost_m;
    if (!both_say_so && !better) continue;
    reversals.pairs.push_back(pair.frames);
    reversals.reversed_m += back.reference_T_scan.norm();
  }
  return reversals;
}

std::optional<LaserMountEstimate> estimate_laser_mount(const std::vector<AlignedPair>& pairs,
                                                       const TPose2D& stated_mount) {
  // A is the robot's motion by odometry, B the laser's motion by scans, X the mount: A X = X B. For the
  // translations, (R_A - 1) s t_X - s R_X t_B = -t_A with the scale s of odometry. This equation is linear in
  // s t_X and in (s cos, s sin) of the mount's heading. Both sides use the turns of the scans, which are more
  // accurate than those of odometry.
  constexpr std::size_t kFewestPairs = 40;
  constexpr double kNoise_m = 0.02;  // residuals beyond this count less
  constexpr int kIterations = 20;
  constexpr double kConverged = 1e-6;
  constexpr double kRulerDeviation = 0.001;  // of the scale of a laser's ranges
  using Row = Eigen::Matrix<double, 2, 4>;
  struct Equation {
    Row row;
    Eigen::Vector2d value;
  };
  std::vector<Equation> equations;
  for (const AlignedPair& pair : pairs) {
    const ScanAlignment& scans = pair.by_scans;
    const double off_rad = wrapToPi(scans.reference_T_scan.phi - pair.by_odometry.phi);
    const bool determined = scans.deviation_along_m(0) < 0.01 && scans.deviation_along_m(M_PI / 2) < 0.01;
    if (!scans.is_reliable() || !determined || std::abs(off_rad) > 0.1) continue;
    const TPose2D laser = between(stated_mount, compose(scans.reference_T_scan, stated_mount));
    const double turn = laser.phi;
    // An error of odometry's turn rotates odometry's translation by half of the error.
    const double bend = off_rad / 2;
    const TPose2D& odometry = pair.by_odometry;
    Equation equation;
    equation.value = {-(portable::cos(bend) * odometry.x - portable::sin(bend) * odometry.y),
                      -(portable::sin(bend) * odometry.x + portable::cos(bend) * odometry.y)};
    equation.row << portable::cos(turn) - 1, -portable::sin(turn), -laser.x, laser.y,  //
        portable::sin(turn), portable::cos(turn) - 1, -laser.y, -laser.x;
    equations.push_back(equation);
  }
  if (equations.size() < kFewestPairs) return std::nullopt;
  // A weak prior keeps what the motion does not determine near the stated mount.
  const Eigen::Vector4d prior(stated_mount.x, stated_mount.y, portable::cos(stated_mount.phi),
                              portable::sin(stated_mount.phi));
  const Eigen::Matrix4d prior_hessian = kNoise_m * kNoise_m * Eigen::Matrix4d::Identity();
  Eigen::Matrix4d hessian;
  // Solves with Cauchy weights, with all equations but [left_out_first, left_out_last).
  const auto solve = [&](Eigen::Vector4d solution, std::size_t left_out_first, std::size_t left_out_last) {
    for (int i = 0; i < kIterations; ++i) {
      hessian = prior_hessian;
      Eigen::Vector4d gradient = prior_hessian * prior;
      for (std::size_t k = 0; k < equations.size(); ++k) {
        if (k >= left_out_first && k < left_out_last) continue;
        const Equation& equation = equations[k];
        const double residual = (equation.row * solution - equation.value).norm() / kNoise_m;
        const double weight = 1 / portable::pow(1 + residual * residual, 2);
        hessian += weight * equation.row.transpose() * equation.row;
        gradient += weight * equation.row.transpose() * equation.value;
      }
      const Eigen::Vector4d before = solution;
      solution = hessian.ldlt().solve(gradient);
      if ((solution - before).cwiseAbs().maxCoeff() < kConverged) break;
    }
    return solution;
  };
  const Eigen::Vector4d solution = solve(prior, 0, 0);
  const Eigen::Matrix4d inverse = hessian.inverse();
  const Eigen::Matrix4d covariance = jackknife_covariance<4>(equations.size(),
                                                             [&](std::size_t first, std::size_t last) {
                                                               return solve(solution, first, last);
                                                             }) +
                                     inverse * kNoise_m * kNoise_m * prior_hessian * inverse;
  LaserMountEstimate estimate;
  estimate.pairs = equations.size();
  const double scale = solution.tail<2>().norm();
  estimate.odometry_scale = scale;
  estimate.robot_T_laser = {solution[0] / scale, solution[1] / scale,
                            portable::atan2(solution[3], solution[2])};
  const Eigen::Vector2d along = solution.tail<2>() / scale;
  const auto deviation_of = [&](double x, double y, const Eigen::Vector2d& heading) {
    const Eigen::Vector4d derivative(x, y, heading.x(), heading.y());
    return std::sqrt(derivative.dot(covariance * derivative)) / scale;
  };
  estimate.deviation_m = std::max(deviation_of(1, 0, -estimate.robot_T_laser.x * along),
                                  deviation_of(0, 1, -estimate.robot_T_laser.y * along));
  estimate.scale_deviation = scale * portable::hypot(deviation_of(0, 0, along), kRulerDeviation);
  estimate.deviation_rad = deviation_of(0, 0, {-along.y(), along.x()});
  return estimate;
}

std::vector<FramePair> suspected_jumps(const std::vector<FrameMark>& marks, double median_period_s,
                                       std::size_t most) {
  std::vector<std::pair<double, FramePair>> suspects;
  for (std::size_t i = 1; i < marks.size(); ++i) {
    const TPose2D step = odometry_between(marks, {i - 1, i});
    const double period_s = std::max(seconds(marks[i].time_us - marks[i - 1].time_us), median_period_s);
    const bool too_far = step.norm() > std::max(kJump_m, kJumpSpeed_m_s * period_s);
    const bool too_fast = std::abs(step.phi) > std::max(kJump_rad, kJumpSpeed_rad_s * period_s);
    if (too_far || too_fast) suspects.push_back({step.norm() + std::abs(step.phi), {i - 1, i}});
  }
  std::stable_sort(suspects.begin(), suspects.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<FramePair> pairs;
  for (std::size_t i = 0; i < std::min(most, suspects.size()); ++i) pairs.push_back(suspects[i].second);
  return pairs;
}

OdometryJumps confirm_jumps(const std::vector<FrameMark>& marks, const std::vector<FramePair>& suspects,
                            const ScanLibrary& library) {
  OdometryJumps jumps;
  for (const FramePair& pair : suspects) {
    const TPose2D step = odometry_between(marks, pair);
    std::vector<TPose2D> guesses{step};
    for (const double turn_deg : {-24.0, -12.0, 0.0, 12.0, 24.0})
      guesses.push_back({0, 0, DEG2RAD(turn_deg)});
    const ScanAlignment alignment =
        align_scans(AlignableScan(library.at(pair.first)), AlignableScan(library.at(pair.second)), guesses);
    const TPose2D& motion = alignment.reference_T_scan;
    const bool stayed = alignment.is_reliable() && motion.norm() < 0.5 * step.norm() + 0.05 &&
                        std::abs(motion.phi) < 0.5 * std::abs(step.phi) + DEG2RAD(5.0);
    if (!stayed) continue;
    jumps.pairs.push_back(pair);
    jumps.largest_m = std::max(jumps.largest_m, step.norm());
    jumps.largest_turn_rad = std::max(jumps.largest_turn_rad, std::abs(step.phi));
  }
  return jumps;
}

RevisitAgreement check_revisits(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                                const ScanLibrary& library) {
  constexpr double kSame_m = 0.05;
  const double same_rad = DEG2RAD(1.0);
  RevisitAgreement agreement;
  agreement.revisits = pairs.size();
  std::vector<double> offsets_m;
  for (const AlignedPair& pair : align_pairs(marks, pairs, library)) {
    const TPose2D off = between(pair.by_odometry, pair.by_scans.reference_T_scan);
    if (!pair.by_scans.is_reliable() || off.norm() > kSame_m || std::abs(off.phi) > same_rad) continue;
    offsets_m.push_back(off.norm());
  }
  agreement.agreeing = offsets_m.size();
  if (offsets_m.empty()) return agreement;
  const auto middle = offsets_m.begin() + static_cast<std::ptrdiff_t>(offsets_m.size() / 2);
  std::nth_element(offsets_m.begin(), middle, offsets_m.end());
  agreement.median_offset_m = *middle;
  return agreement;
}

}  // namespace psi_slam
