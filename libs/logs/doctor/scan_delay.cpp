// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/scan_delay.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <limits>

#include "base/median.h"
#include "base/portable_math.h"
#include "logs/doctor/jackknife.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/odometry_track.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

constexpr std::size_t kFewestTurns = 40;
constexpr int kCandidates = 20;  // on each side of 0
constexpr double kSlopeStep_s = 0.02;
constexpr int kIterations = 20;
constexpr double kConverged = 1e-5;  // last change of the delay in seconds and of the ratio of turns
// Residuals beyond this count less (Cauchy weights): odometry that slips, scans that are badly aligned.
const double kNoise_rad = mrpt::DEG2RAD(1.0);
constexpr double kGainDeviation = 0.3;  // of the ratio of turns, before any scan is compared
constexpr double kOffsetStep_s = 0.1;   // turns of robots take longer
constexpr double kMostOffset_s = 300;
constexpr std::size_t kTurnsForOffset = 200;
constexpr double kFarBetter = 0.5;  // ratio of the mean costs of an offset of clocks and of its rivals

/// Hessian of a weak prior: without turns, the delay and the ratio of turns stay.
Eigen::Matrix2d prior_hessian() {
  return Eigen::Vector2d(portable::pow(kNoise_rad / kMostEstimatedDelay_s, 2),
                         portable::pow(kNoise_rad / kGainDeviation, 2))
      .asDiagonal();
}

/// Returns headings (TPose2D::phi) at four times for each pose, each the mean over two periods of odometry as
/// interpolated between its poses, of times and of headings. Interpolated headings are less noisy midway
/// between poses, which attracts delays. The noise of these means is the same at all times.
OdometryTrack smoothed(const std::vector<FrameMark>& poses) {
  constexpr int kTimes = 4;
  std::vector<double> headings_rad = unwrapped_headings(poses);
  OdometryTrack track;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    for (int k = 0; k < kTimes; ++k) {
      const double after = static_cast<double>(k) / kTimes;
      const std::array<double, 4> weights{(1 - after) * (1 - after) / 4, (2 - after * after) / 4,
                                          (1 + 2 * after - after * after) / 4, after * after / 4};
      double time_us = 0;
      double heading_rad = 0;
      for (std::size_t j = 0; j < weights.size(); ++j) {
        const std::size_t pose = std::clamp<std::size_t>(i + j, 1, poses.size()) - 1;
        time_us += weights[j] * static_cast<double>(poses[pose].time_us - poses[i].time_us);
        heading_rad += weights[j] * headings_rad[pose];
      }
      track.add(poses[i].time_us + std::llround(time_us), {0, 0, wrapToPi(heading_rad)});
    }
  }
  return track;
}

enum class Headings { kRecorded, kSmoothed };

/// Odometry of all marks at shifted times. Smoothed odometry has headings only.
class ShiftedOdometry {
 public:
  explicit ShiftedOdometry(const std::vector<FrameMark>& marks, Headings headings = Headings::kRecorded)
      : marks_(marks), tracks_(1) {
    track_of_.reserve(marks.size());
    for (const FrameMark& mark : marks) {
      if (tracks_.back().ends_before(mark.time_us)) tracks_.emplace_back();
      if (begins_us_.size() < tracks_.size()) begins_us_.push_back(mark.time_us);
      tracks_.back().add(mark.time_us, mark.odom_T_robot);
      track_of_.push_back(tracks_.size() - 1);
    }
    if (headings == Headings::kSmoothed) smooth();
  }

  /// Odometry of a frame whose scan was measured `delay_s` before its time stamp.
  TPose2D at(std::size_t frame, double delay_s) const {
    return tracks_[track_of_[frame]].at(marks_[frame].time_us -
                                        static_cast<TimeUs>(std::lround(1e6 * delay_s)));
  }

  /// Returns whether the track has odometry of the times at which both scans were measured.
  bool covers(const FramePair& pair, double delay_s) const {
    const std::size_t track = track_of_[pair.first];
    const auto delay_us = static_cast<TimeUs>(std::lround(1e6 * delay_s));
    return track_of_[pair.second] == track && marks_[pair.first].time_us - delay_us >= begins_us_[track] &&
           marks_[pair.second].time_us - delay_us <= tracks_[track].end_us();
  }

  double turn_rad(const FramePair& pair, double delay_s) const {
    return wrapToPi(at(pair.second, delay_s).phi - at(pair.first, delay_s).phi);
  }

 private:
  void smooth() {
    std::vector<std::vector<FrameMark>> poses(tracks_.size());
    for (std::size_t i = 0; i < marks_.size(); ++i) poses[track_of_[i]].push_back(marks_[i]);
    for (std::size_t track = 0; track < tracks_.size(); ++track) {
      std::stable_sort(poses[track].begin(), poses[track].end(),
                       [](const FrameMark& a, const FrameMark& b) { return a.time_us < b.time_us; });
      tracks_[track] = smoothed(poses[track]);
    }
  }

  const std::vector<FrameMark>& marks_;
  std::vector<OdometryTrack> tracks_;
  std::vector<TimeUs> begins_us_;  // of the tracks
  std::vector<std::size_t> track_of_;
};

/// Cost of a difference of turns, limited by the logarithm: odometry slips, and alignments fail.
double cost_of(double residual_rad) {
  return portable::log1p(portable::pow(wrapToPi(residual_rad) / kNoise_rad, 2));
}

/// Returns the multiple of the candidates' step that explains the turns best. Empty if the limit does.
std::optional<double> best_candidate_s(const ShiftedOdometry& odometry, const std::vector<ScanTurn>& turns) {
  int best = 0;
  double lowest = std::numeric_limits<double>::infinity();
  for (int i = 0; i <= 2 * kCandidates; ++i) {  // 0, -1, 1, -2, 2, ...: of equal costs, the smallest delay
    const int k = i % 2 == 0 ? i / 2 : -(i + 1) / 2;
    double cost = 0;
    for (const ScanTurn& turn : turns)
      cost +=
          cost_of(turn.turn_rad - odometry.turn_rad(turn.frames, kMostEstimatedDelay_s * k / kCandidates));
    if (cost >= lowest) continue;
    lowest = cost;
    best = k;
  }
  if (std::abs(best) == kCandidates) return std::nullopt;
  return kMostEstimatedDelay_s * best / kCandidates;
}

/// Delay and ratio of turns that explain the turns best, near a candidate.
struct DelayFit {
  Eigen::Vector2d estimate;  // delay in seconds, ratio of turns
  Eigen::Matrix2d hessian;   // of the squared residuals and the prior
};

/// Fits by Gauss-Newton steps, with all turns but [left_out_first, left_out_last).
DelayFit fit_delay(const ShiftedOdometry& odometry, const std::vector<ScanTurn>& turns, double candidate_s,
                   Eigen::Vector2d start, std::size_t left_out_first, std::size_t left_out_last) {
  const Eigen::Vector2d prior(candidate_s, 1);
  DelayFit fit{start, {}};
  for (int i = 0; i < kIterations; ++i) {
    fit.hessian = prior_hessian();
    Eigen::Vector2d gradient = fit.hessian * (prior - fit.estimate);
    for (std::size_t k = 0; k < turns.size(); ++k) {
      if (k >= left_out_first && k < left_out_last) continue;
      const FramePair& frames = turns[k].frames;
      const double turn_rad = odometry.turn_rad(frames, fit.estimate[0]);
      const double slope = wrapToPi(odometry.turn_rad(frames, fit.estimate[0] + kSlopeStep_s) -
                                    odometry.turn_rad(frames, fit.estimate[0] - kSlopeStep_s)) /
                           (2 * kSlopeStep_s);
      const double residual = wrapToPi(turns[k].turn_rad - fit.estimate[1] * turn_rad);
      const double weight = 1 / (1 + portable::pow(residual / kNoise_rad, 2));
      const Eigen::Vector2d jacobian(fit.estimate[1] * slope, turn_rad);
      fit.hessian += weight * jacobian * jacobian.transpose();
      gradient += weight * residual * jacobian;
    }
    const Eigen::Vector2d step = fit.hessian.ldlt().solve(gradient);
    fit.estimate += step;
    if (step.cwiseAbs().maxCoeff() < kConverged) break;
  }
  return fit;
}

/// Estimates the delay near a candidate by Gauss-Newton steps. Empty if the delay leaves the candidate by
/// kMostEstimatedDelay_s.
std::optional<ScanDelay> refined(const ShiftedOdometry& odometry, const std::vector<ScanTurn>& turns,
                                 double candidate_s) {
  const DelayFit fit = fit_delay(odometry, turns, candidate_s, {candidate_s, 1}, 0, 0);
  if (!(std::abs(fit.estimate[0] - candidate_s) < kMostEstimatedDelay_s)) return std::nullopt;
  const Eigen::Matrix2d inverse = fit.hessian.inverse();
  const Eigen::Matrix2d covariance =
      jackknife_covariance<2>(
          turns.size(),
          [&](std::size_t first, std::size_t last) {
            return fit_delay(odometry, turns, candidate_s, fit.estimate, first, last).estimate;
          }) +
      inverse * kNoise_rad * kNoise_rad * prior_hessian() * inverse;
  return ScanDelay{turns.size(), fit.estimate[0], std::sqrt(covariance(0, 0))};
}

/// Mean cost of the turns under the assumption that odometry turns `factor` times as far, at the same times.
double cost_of_factor(const ShiftedOdometry& odometry, const std::vector<ScanTurn>& turns, double factor) {
  double cost = 0;
  for (const ScanTurn& turn : turns)
    cost += cost_of(factor * turn.turn_rad - odometry.turn_rad(turn.frames, 0));
  return cost / static_cast<double>(turns.size());
}

/// Mean cost of the turns at a delay, over those whose times odometry covers. Infinite if it covers less than
/// half of them.
double mean_cost_at(const ShiftedOdometry& odometry, const std::vector<ScanTurn>& turns, double delay_s) {
  double cost = 0;
  std::size_t covered = 0;
  for (const ScanTurn& turn : turns) {
    if (!odometry.covers(turn.frames, delay_s)) continue;
    ++covered;
    cost += cost_of(turn.turn_rad - odometry.turn_rad(turn.frames, delay_s));
  }
  return 2 * covered < turns.size() ? std::numeric_limits<double>::infinity()
                                    : cost / static_cast<double>(covered);
}

}  // namespace

std::optional<ScanDelay> estimate_scan_delay(const std::vector<FrameMark>& marks,
                                             const std::vector<ScanTurn>& turns) {
  if (turns.size() < kFewestTurns || 2 * median(periods_between(marks)) > kMostEstimatedDelay_s)
    return std::nullopt;
  const ShiftedOdometry odometry(marks);
  const auto candidate_s = best_candidate_s(odometry, turns);
  if (!candidate_s) return std::nullopt;
  const auto delay = refined(ShiftedOdometry(marks, Headings::kSmoothed), turns, *candidate_s);
  if (!delay || !(std::abs(delay->delay_s) < kMostEstimatedDelay_s)) return std::nullopt;
  return delay;
}

std::optional<ScanDelay> estimate_clock_offset(const std::vector<FrameMark>& marks,
                                               const std::vector<ScanTurn>& turns) {
  if (turns.size() < kFewestTurns) return std::nullopt;
  const ShiftedOdometry odometry(marks);
  std::vector<ScanTurn> some;  // enough to find the offset
  for (std::size_t i = 0; i < turns.size(); i += turns.size() / kTurnsForOffset + 1) some.push_back(turns[i]);
  double rival = cost_of_factor(odometry, some, 0);
  for (const double degrees : {mrpt::RAD2DEG(1.0), -mrpt::RAD2DEG(1.0)})
    rival = std::min(rival, cost_of_factor(odometry, some, degrees));
  double best_s = 0;
  double lowest = std::numeric_limits<double>::infinity();
  const double half_s = seconds(marks.back().time_us - marks.front().time_us) / 2;
  for (int k = 0; k * kOffsetStep_s < std::min(kMostOffset_s, half_s); ++k) {
    for (const double delay_s : {-k * kOffsetStep_s, k * kOffsetStep_s}) {
      const double cost = mean_cost_at(odometry, some, delay_s);
      if (std::abs(delay_s) <= kMostEstimatedDelay_s) rival = std::min(rival, cost);
      if (cost >= lowest) continue;
      lowest = cost;
      best_s = delay_s;
    }
  }
  if (lowest > kFarBetter * rival) return std::nullopt;
  std::vector<ScanTurn> covered;
  for (const ScanTurn& turn : turns)
    if (odometry.covers(turn.frames, best_s)) covered.push_back(turn);
  return refined(odometry, covered, best_s);
}

std::vector<FrameMark> with_scan_delay(const std::vector<FrameMark>& marks, double delay_s) {
  const ShiftedOdometry odometry(marks);
  std::vector<FrameMark> shifted = marks;
  for (std::size_t i = 0; i < marks.size(); ++i) shifted[i].odom_T_robot = odometry.at(i, delay_s);
  return shifted;
}

}  // namespace psi_slam
