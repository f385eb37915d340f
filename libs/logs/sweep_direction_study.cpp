// SPDX-License-Identifier: BSD-3-Clause
#include "logs/sweep_direction_study.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/deskewed_source.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_alignment.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

// Limits of what is read. Scans of fast lasers are thinned.
constexpr double kLeastPeriod_s = 0.08;
constexpr std::size_t kMostFrames = 6000;
constexpr std::size_t kMostScans = 1500;  // of one laser, after thinning
constexpr double kEnoughTurns_rad = 8 * 2 * M_PI;
constexpr std::size_t kScansWithoutSweep = 20;  // a laser whose first scans state no sweep time has none

// Pairs of scans.
constexpr std::size_t kMostPairs = 60;
constexpr std::size_t kLongestPair = 50;  // in scans
constexpr double kPairDistance_m = 0.4;
const double kPairTurn_rad = DEG2RAD(45.0);
const double kLeastBend_rad = DEG2RAD(0.6);
constexpr double kMaxBetweenScans_s = 1.0;  // during a longer time, the turn rate is unknown unless 0

// Odometry that moves less between two scans stands still.
constexpr double kStill_m = 1e-3;
constexpr double kStill_rad = 1e-3;
constexpr std::size_t kStillStepsKept = 3;

// Scans without odometry are aligned one after the other for guesses only, which need fewer points.
constexpr double kFarthest_m = 30.0;
constexpr std::size_t kPointsForGuess = 100;

constexpr double kBentCost_m = 0.08;  // largest cost of a reliable alignment of scans as recorded

// An order is ruled out if its distances to walls exceed those of the best order by both limits.
constexpr std::size_t kFewestPairs = 12;
constexpr double kWorseFraction = 0.02;  // of the smallest mean distance
constexpr double kWorseErrors = 4;       // in standard errors
// The cost grows with the square of the remaining bend, so no sweep is worse than the right direction by a
// quarter of what the reverse direction is.
constexpr double kNoSweepWorseErrors = kWorseErrors / 4;

struct Sample {
  TimeUs time_us = 0;
  TPose2D guess_T_robot;    // by odometry, or by alignment one after the other
  std::size_t stretch = 0;  // poses of different stretches cannot be compared
  bool has_odometry = false;
  LaserScan scan;  // with a positive sweep time
};

bool stands(const TPose2D& motion) {
  return motion.norm() < kStill_m && std::abs(wrapToPi(motion.phi)) < kStill_rad;
}

/// Two scans of one place with different bends.
struct Candidate {
  std::size_t first = 0;
  std::size_t second = 0;
  double bend_rad = 0;  // difference of the bends
};

/// The orders that the study compares, by the sign of their sweep times.
constexpr std::array<int, 3> kOrders{+1, -1, 0};
using Distances = std::array<double, kOrders.size()>;  // in the order of kOrders

/// Scans of one laser.
class LaserSamples {
 public:
  void add(Frame frame, std::optional<double> sweep_time_s) {
    const auto stated_s = static_cast<double>(frame.scan.sweep_time_s);
    const double sweep_s = std::abs(sweep_time_s.value_or(stated_s));
    if (!(sweep_s > 0) || frame.scan.ranges_m.size() < 2) {
      ++without_sweep_;
      return;
    }
    ++scans_;
    stated_sweep_time_s_ = std::copysign(sweep_s, stated_s);
    const bool follows = !samples_.empty();
    const double since_s = follows ? seconds(frame.time_us - samples_.back().time_us) : 0;
    if (follows && since_s >= 0 && since_s < kLeastPeriod_s) return;
    frame.scan.sweep_time_s = static_cast<float>(sweep_s);
    Sample sample{frame.time_us, frame.odom_T_robot, 0, frame.has_odometry, std::move(frame.scan)};
    if (follows) continue_from(samples_.back(), sample);
    still_steps_ = follows && stands_with_odometry(samples_.back(), sample) ? still_steps_ + 1 : 0;
    if (still_steps_ > kStillStepsKept) {  // keeps the ends of a pause, so that waiting fills no memory
      samples_.erase(samples_.end() - 2);
      still_steps_ = kStillStepsKept;
    }
    samples_.push_back(std::move(sample));
  }

  bool is_enough() const {
    return samples_.size() >= kMostScans || turned_rad_ > kEnoughTurns_rad ||
           (samples_.empty() && without_sweep_ >= kScansWithoutSweep);
  }

  SweepDirectionStudy study() const;

 private:
  static bool stands_with_odometry(const Sample& from, const Sample& to) {
    return from.has_odometry && to.has_odometry && stands(between(from.guess_T_robot, to.guess_T_robot));
  }

  /// Sets the pose of a sample without odometry and the stretch.
  void continue_from(const Sample& last, Sample& sample) {
    bool joined = last.has_odometry == sample.has_odometry && sample.time_us > last.time_us;
    if (joined && !sample.has_odometry) joined = align_to(last, sample);
    sample.stretch = joined ? last.stretch : last.stretch + 1;
    if (joined) turned_rad_ += std::abs(wrapToPi(sample.guess_T_robot.phi - last.guess_T_robot.phi));
    if (!joined) last_step_ = {0, 0, 0};
  }

  bool align_to(const Sample& last, Sample& sample) {
    const AlignableScan reference(last.scan, kFarthest_m, kPointsForGuess);
    const AlignableScan scan(sample.scan, kFarthest_m, kPointsForGuess);
    ScanAlignment alignment = align_scans(reference, scan, last_step_);
    if (!alignment.is_reliable(kBentCost_m)) {
      std::vector<TPose2D> guesses;
      for (const double turn_deg : {-30.0, -20.0, -10.0, 0.0, 10.0, 20.0, 30.0})
        guesses.push_back({0, 0, DEG2RAD(turn_deg)});
      alignment = align_scans(reference, scan, guesses);
    }
    if (!alignment.is_reliable(kBentCost_m)) return false;
    last_step_ = alignment.reference_T_scan;
    sample.guess_T_robot = compose(last.guess_T_robot, last_step_);
    return true;
  }

  bool has_neighbours(std::size_t i) const {
    return i > 0 && i + 1 < samples_.size() && samples_[i - 1].stretch == samples_[i + 1].stretch;
  }

  /// Returns the motion from the sample before to the sample after, by the guessed poses.
  TPose2D guess_around(std::size_t i) const {
    return between(samples_[i - 1].guess_T_robot, samples_[i + 1].guess_T_robot);
  }

  /// Returns the robot's motion during the sweep of a sample. `around` is the motion from the sample before
  /// to the sample after.
  TPose2D motion_during(std::size_t i, const TPose2D& around) const {
    const double around_s = seconds(samples_[i + 1].time_us - samples_[i - 1].time_us);
    return interpolate({0, 0, 0}, around, static_cast<double>(samples_[i].scan.sweep_time_s) / around_s);
  }

  /// Returns the robot's turn during the sweep of a sample, by the guessed poses. Empty if it is unknown.
  std::optional<double> guessed_bend_rad(std::size_t i) const {
    if (!has_neighbours(i)) return std::nullopt;
    const double before_s = seconds(samples_[i].time_us - samples_[i - 1].time_us);
    const double after_s = seconds(samples_[i + 1].time_us - samples_[i].time_us);
    const TPose2D around = guess_around(i);
    const bool is_known = std::max(before_s, after_s) <= kMaxBetweenScans_s || stands(around);
    if (!is_known || static_cast<double>(samples_[i].scan.sweep_time_s) > before_s + after_s)
      return std::nullopt;
    return motion_during(i, around).phi;
  }

  std::vector<Candidate> candidates() const;
  std::optional<TPose2D> aligned_motion_during(std::size_t i) const;
  std::optional<Distances> distances_m(const Candidate& pair, double& bend_rad) const;

  std::vector<Sample> samples_;
  std::size_t scans_ = 0;
  std::size_t without_sweep_ = 0;
  std::size_t still_steps_ = 0;  // steps between the last samples, in all of which the robot stands
  double stated_sweep_time_s_ = 0;
  double turned_rad_ = 0;
  TPose2D last_step_;  // motion to the last sample, without odometry
};

/// Returns pairs with the largest differences of bends, largest first. Each sample belongs to one pair at
/// most.
std::vector<Candidate> LaserSamples::candidates() const {
  std::vector<std::optional<double>> bends_rad(samples_.size());
  for (std::size_t i = 0; i < samples_.size(); ++i) bends_rad[i] = guessed_bend_rad(i);
  std::vector<Candidate> all;
  for (std::size_t i = 0; i < samples_.size(); ++i) {
    if (!bends_rad[i]) continue;
    Candidate best{i, i, 0};
    for (std::size_t j = i + 1; j < std::min(i + kLongestPair, samples_.size()); ++j) {
      if (samples_[j].stretch != samples_[i].stretch) break;
      const TPose2D motion = between(samples_[i].guess_T_robot, samples_[j].guess_T_robot);
      if (motion.norm() > kPairDistance_m || std::abs(wrapToPi(motion.phi)) > kPairTurn_rad) break;
      if (!bends_rad[j]) continue;
      const double bend_rad = std::abs(*bends_rad[j] - *bends_rad[i]);
      if (bend_rad > best.bend_rad) best = {i, j, bend_rad};
    }
    if (best.bend_rad >= kLeastBend_rad) all.push_back(best);
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.bend_rad > b.bend_rad; });
  std::vector<Candidate> chosen;
  std::vector<bool> is_used(samples_.size(), false);
  for (const Candidate& pair : all) {
    if (is_used[pair.first] || is_used[pair.second]) continue;
    is_used[pair.first] = is_used[pair.second] = true;
    chosen.push_back(pair);
    if (chosen.size() == kMostPairs) break;
  }
  return chosen;
}

/// Returns the robot's motion during the sweep of a sample by the alignment of the sample's neighbours. Empty
/// if they do not align.
std::optional<TPose2D> LaserSamples::aligned_motion_during(std::size_t i) const {
  const ScanAlignment alignment =
      align_scans(AlignableScan(samples_[i - 1].scan), AlignableScan(samples_[i + 1].scan), guess_around(i));
  if (!alignment.is_reliable(kBentCost_m)) return std::nullopt;
  return motion_during(i, alignment.reference_T_scan);
}

LaserScan deskewed_in_order(LaserScan scan, const TPose2D& motion, int order) {
  if (order == 0) return scan;
  scan.sweep_time_s = std::copysign(scan.sweep_time_s, static_cast<float>(order));
  return deskewed(scan, motion);
}

/// Returns the mean distances of points to walls for each order, metres, and sets the difference of the
/// bends. Empty if no order aligns the scans reliably.
std::optional<Distances> LaserSamples::distances_m(const Candidate& pair, double& bend_rad) const {
  const Sample& first = samples_[pair.first];
  const Sample& second = samples_[pair.second];
  const auto first_motion = aligned_motion_during(pair.first);
  const auto second_motion = aligned_motion_during(pair.second);
  if (!first_motion || !second_motion) return std::nullopt;
  bend_rad = std::abs(second_motion->phi - first_motion->phi);
  Distances distances{};
  bool any_reliable = false;
  for (std::size_t k = 0; k < kOrders.size(); ++k) {
    const ScanAlignment alignment =
        align_scans(AlignableScan(deskewed_in_order(first.scan, *first_motion, kOrders[k])),
                    AlignableScan(deskewed_in_order(second.scan, *second_motion, kOrders[k])),
                    between(first.guess_T_robot, second.guess_T_robot));
    any_reliable = any_reliable || alignment.is_reliable();
    distances[k] = alignment.cost_m;
  }
  if (!any_reliable) return std::nullopt;
  return distances;
}

/// Sets the evidence for each order. `fits` are in the order of kOrders.
void compare_distances(const std::vector<Distances>& rows,
                       const std::array<SweepFit*, kOrders.size()>& fits) {
  const auto count = static_cast<double>(rows.size());
  for (std::size_t k = 0; k < fits.size(); ++k)
    for (const Distances& row : rows) fits[k]->mean_distance_m += row[k] / count;
  std::size_t best = 0;
  for (std::size_t k = 1; k < fits.size(); ++k)
    if (fits[k]->mean_distance_m < fits[best]->mean_distance_m) best = k;
  for (std::size_t k = 0; k < fits.size(); ++k) {
    SweepFit& fit = *fits[k];
    fit.worse_by_m = fit.mean_distance_m - fits[best]->mean_distance_m;
    // Relative differences limit the influence of a single pair.
    const auto difference = [&](const Distances& row) {
      return row[k] == row[best] ? 0 : (row[k] - row[best]) / (row[k] + row[best]);
    };
    double mean = 0;
    for (const Distances& row : rows) mean += difference(row) / count;
    double squares = 0;
    for (const Distances& row : rows) squares += portable::pow(difference(row) - mean, 2);
    const double error = std::sqrt(squares) / count;
    fit.significance = error > 0 ? mean / error : 0;
    fit.ruled_out = rows.size() >= kFewestPairs && fit.significance > kWorseErrors &&
                    fit.worse_by_m > kWorseFraction * fits[best]->mean_distance_m;
  }
}

SweepDirectionStudy study_of(const std::vector<Distances>& rows) {
  SweepDirectionStudy study;
  study.pairs = rows.size();
  if (!rows.empty()) compare_distances(rows, {&study.forward, &study.backward, &study.at_once});
  return study;
}

/// Compares pairs of scans, those with the largest bends first, until they determine the direction.
SweepDirectionStudy LaserSamples::study() const {
  std::vector<Distances> rows;
  double bends_rad = 0;
  for (const Candidate& pair : candidates()) {
    double bend_rad = 0;
    const auto row = distances_m(pair, bend_rad);
    if (!row) continue;
    bends_rad += bend_rad;
    rows.push_back(*row);
    if (rows.size() % kFewestPairs == 0 && study_of(rows).direction() != SweepDirection::kAuto) break;
  }
  SweepDirectionStudy study = study_of(rows);
  study.scans = scans_;
  study.stated_sweep_time_s = stated_sweep_time_s_;
  if (!rows.empty()) study.mean_bend_rad = bends_rad / static_cast<double>(rows.size());
  return study;
}

}  // namespace

SweepDirection SweepDirectionStudy::direction() const {
  if (!(at_once.significance > kNoSweepWorseErrors)) return SweepDirection::kAuto;
  if (backward.ruled_out && forward.worse_by_m == 0) return SweepDirection::kForward;
  if (forward.ruled_out && backward.worse_by_m == 0) return SweepDirection::kBackward;
  return SweepDirection::kAuto;
}

std::vector<SweepDirectionStudy> study_sweep_directions(FrameSource& log,
                                                        std::optional<double> sweep_time_s) {
  std::vector<LaserSamples> lasers;
  try {
    for (std::size_t i = 0; i < kMostFrames; ++i) {
      std::optional<Frame> frame = log.next();
      if (!frame) break;
      const std::size_t laser = frame->scan.laser;
      if (laser >= lasers.size()) lasers.resize(laser + 1);
      if (!lasers[laser].is_enough()) lasers[laser].add(std::move(*frame), sweep_time_s);
      if (std::all_of(lasers.begin(), lasers.end(), [](const LaserSamples& s) { return s.is_enough(); }))
        break;
    }
  } catch (const UserError&) {
    // The error is reported when the log is mapped. The scans before it suffice here.
  }
  std::vector<SweepDirectionStudy> studies;
  studies.reserve(lasers.size());
  for (const LaserSamples& samples : lasers) studies.push_back(samples.study());
  return studies;
}

}  // namespace psi_slam
