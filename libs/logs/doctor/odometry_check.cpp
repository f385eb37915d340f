// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/odometry_check.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/scan_alignment.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;
using mrpt::math::wrapToPi;

constexpr std::size_t kFramesInTrack = 15;
constexpr double kTrackLength_m = 0.5;  // in a longer track, first and last scan overlap too little
const double kTrackTurn_rad = DEG2RAD(25.0);
constexpr double kGoodCost_m = 0.06;
constexpr double kLeastLength_m = 0.1;
constexpr double kLengthDeviation_m = 0.02;
constexpr double kUndecidedCost_m = 0.01;  // two poses with a smaller difference of cost fit equally well
const double kHeadingDeviation_rad = DEG2RAD(0.4);
constexpr std::size_t kFewestSamples = 8;
const double kLeastTurn_rad = DEG2RAD(1.2);
constexpr double kDegreesPerRadian = 180.0 / M_PI;
constexpr double kLeastResultant = 0.35;
constexpr double kEnlarged = 5;     // ratio of turns, far above that of odometry of another time or robot
constexpr double kSameRatio = 0.3;  // of lengths
const double kStill_rad = DEG2RAD(3.0);
constexpr double kClearShare = 0.9;  // of turns that agree: no other clock would explain more

/// Turns between two consecutive frames of a track.
struct Step {
  FramePair frames;
  double scan_turn_rad;
  double odometry_turn_rad;
};

struct Track {
  TPose2D by_scans;  // pose of the last frame relative to the first
  TPose2D by_odometry;
  bool tells_length = false;  ///< the scans determine the length of `by_scans`
  std::vector<Step> steps;
};

Eigen::Vector2d unit_vector(double angle_rad) {
  const auto [sin, cos] = portable::sin_cos(angle_rad);
  return {cos, sin};
}

/// Guesses around a pose that assume no motion model: turned to both sides, behind and ahead.
std::vector<TPose2D> fan_of_guesses(const TPose2D& around) {
  std::vector<TPose2D> guesses;
  for (const double turn_deg : {-40.0, -27.0, -18.0, -9.0, 0.0, 9.0, 18.0, 27.0, 40.0})
    guesses.push_back(compose(around, TPose2D{0, 0, DEG2RAD(turn_deg)}));
  for (const double ahead_m : {-0.4, 0.4, 0.8}) guesses.push_back(compose(around, TPose2D{ahead_m, 0, 0}));
  return guesses;
}

/// Returns whether an alignment determines how far the robot moved. Along a bare corridor, beams that graze
/// the walls hold each scan where it is: aligned from the pose by odometry, the scan then fits another pose
/// about as well.
bool determines_length(const ScanAlignment& alignment, const AlignableScan& reference,
                       const AlignableScan& scan, const TPose2D& by_odometry) {
  const TPose2D& by_scans = alignment.reference_T_scan;
  const double laser_heading_rad = reference.robot_T_laser().phi;  // the covariance is in the laser's frame
  if (by_scans.norm() < kLeastLength_m ||
      alignment.deviation_along_m(portable::atan2(by_scans.y, by_scans.x) - laser_heading_rad) >
          kLengthDeviation_m)
    return false;
  const ScanAlignment other = align_scans(reference, scan, by_odometry);
  return other.cost_m > alignment.cost_m + kUndecidedCost_m ||
         between(by_scans, other.reference_T_scan).norm() <= kLengthDeviation_m;
}

std::optional<Track> follow(const std::vector<FrameMark>& marks, const std::vector<std::size_t>& frames,
                            const ScanLibrary& library) {
  const AlignableScan reference(library.at(frames.front()));
  Track track;
  TPose2D now{0, 0, 0};
  TPose2D last_step{0, 0, 0};
  ScanAlignment newest;
  for (std::size_t k = 1; k < frames.size(); ++k) {
    if (!have_same_span(library.at(frames.front()), library.at(frames[k]))) break;
    const AlignableScan scan(library.at(frames[k]));
    const FramePair step{frames[k - 1], frames[k]};
    const TPose2D odometry_step = odometry_between(marks, step);
    ScanAlignment alignment = align_scans(reference, scan, compose(now, last_step));
    if (!alignment.is_reliable(kGoodCost_m)) alignment = align_scans(reference, scan, now);
    if (!alignment.is_reliable(kGoodCost_m)) {
      std::vector<TPose2D> guesses = fan_of_guesses(now);
      guesses.push_back(compose(now, odometry_step));
      alignment = align_scans(reference, scan, guesses);
    }
    if (!alignment.is_reliable(kGoodCost_m) || alignment.heading_deviation_rad() > kHeadingDeviation_rad)
      break;
    last_step = between(now, alignment.reference_T_scan);
    now = alignment.reference_T_scan;
    track.by_scans = now;
    track.by_odometry = odometry_between(marks, {frames.front(), frames[k]});
    newest = alignment;
    track.steps.push_back({step, last_step.phi, wrapToPi(odometry_step.phi)});
    if (now.norm() > kTrackLength_m || std::abs(now.phi) > kTrackTurn_rad) break;
  }
  if (track.steps.empty()) return std::nullopt;
  track.tells_length = determines_length(
      newest, reference, AlignableScan(library.at(track.steps.back().frames.second)), track.by_odometry);
  return track;
}

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

void compare_lengths(const std::vector<Track>& tracks, OdometryAgreement& agreement) {
  std::vector<double> ratios;
  std::vector<double> slips_rad;
  Eigen::Vector2d directions = Eigen::Vector2d::Zero();
  for (const Track& track : tracks) {
    const double by_scans_m = track.by_scans.norm();
    const double by_odometry_m = track.by_odometry.norm();
    agreement.scan_path_m += by_scans_m;
    agreement.odometry_path_m += by_odometry_m;
    if (!track.tells_length) continue;
    ratios.push_back(by_odometry_m / by_scans_m);
    if (by_odometry_m == 0) continue;
    const double odometry_direction = portable::atan2(track.by_odometry.y, track.by_odometry.x);
    const double scan_direction = portable::atan2(track.by_scans.y, track.by_scans.x);
    directions += unit_vector(scan_direction - odometry_direction);
    slips_rad.push_back(std::abs(std::remainder(odometry_direction - track.by_odometry.phi / 2, M_PI)));
  }
  agreement.length_samples = ratios.size();
  if (ratios.size() < kFewestSamples) return;
  agreement.length_ratio = quantile(ratios, 0.5);
  const auto near = std::count_if(ratios.begin(), ratios.end(), [&](double ratio) {
    return std::abs(ratio - agreement.length_ratio) <= kSameRatio * agreement.length_ratio;
  });
  agreement.length_share = static_cast<double>(near) / static_cast<double>(ratios.size());
  if (slips_rad.size() < kFewestSamples) return;
  agreement.direction_offset_rad = portable::atan2(directions.y(), directions.x());
  agreement.direction_concentration = directions.norm() / static_cast<double>(slips_rad.size());
  agreement.odometry_slip_rad = quantile(slips_rad, 0.5);
}

/// Returns whether odometry turned `factor` times as far as the scans. Turns of scans are accurate to about
/// half a degree. Turns of odometry are less accurate and may belong to another moment of a fast turn.
bool fits(const Step& step, double factor) {
  const double tolerance_rad = DEG2RAD(0.6) + 0.35 * std::abs(step.scan_turn_rad * factor);
  return std::abs(wrapToPi(step.odometry_turn_rad - factor * step.scan_turn_rad)) <= tolerance_rad;
}

/// Returns whether the heading of odometry ever changes.
bool turns_anywhere(const std::vector<FrameMark>& marks) {
  const std::vector<double> headings_rad = unwrapped_headings(marks);
  const auto [least, most] = std::minmax_element(headings_rad.begin(), headings_rad.end());
  return !headings_rad.empty() && *most - *least > kStill_rad;
}

/// Returns how well the turns of odometry match the turns of the scans if odometry is in degrees that were
/// wrapped as radians. 1: perfect agreement; 0: unrelated turns, or most turns of odometry are not enlarged.
/// Tries small turns first: degrees enlarge the errors of turns 57 times.
double degrees_resultant(const std::vector<Step>& steps, double factor) {
  for (const double most_rad : {DEG2RAD(2.5), DEG2RAD(6.0)}) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    std::size_t count = 0;
    std::size_t enlarged = 0;
    for (const Step& step : steps) {
      const double turn_rad = std::abs(step.scan_turn_rad);
      if (turn_rad < DEG2RAD(0.3) || turn_rad > most_rad) continue;
      sum += unit_vector(step.odometry_turn_rad - factor * step.scan_turn_rad);
      ++count;
      if (std::abs(step.odometry_turn_rad) > kEnlarged * turn_rad) ++enlarged;
    }
    if (count < 3 * kFewestSamples) continue;
    return 2 * enlarged > count ? sum.norm() / static_cast<double>(count) : 0;
  }
  return 0;
}

void compare_turns(const std::vector<Track>& tracks, OdometryAgreement& agreement) {
  std::vector<Step> steps;
  for (const Track& track : tracks) steps.insert(steps.end(), track.steps.begin(), track.steps.end());
  std::map<HeadingRelation, std::size_t> fitting;
  for (const Step& step : steps) {
    agreement.turns.push_back({step.frames, step.scan_turn_rad});
    if (std::abs(step.scan_turn_rad) < kLeastTurn_rad) continue;
    ++agreement.turn_samples;
    if (fits(step, 1)) ++fitting[HeadingRelation::kAgrees];
    if (fits(step, -1)) ++fitting[HeadingRelation::kOpposite];
    if (fits(step, 0)) ++fitting[HeadingRelation::kNone];
  }
  if (agreement.turn_samples < kFewestSamples) return;
  agreement.heading = HeadingRelation::kUnrelated;
  for (const auto& [relation, count] : fitting) {
    const double share = static_cast<double>(count) / static_cast<double>(agreement.turn_samples);
    if (share > std::max(0.5, agreement.heading_share)) agreement.heading = relation;
    agreement.heading_share = std::max(agreement.heading_share, share);
  }
  if (agreement.heading != HeadingRelation::kUnrelated) return;
  const double degrees = degrees_resultant(steps, kDegreesPerRadian);
  const double opposite_degrees = degrees_resultant(steps, -kDegreesPerRadian);
  if (std::max(degrees, opposite_degrees) < kLeastResultant) return;
  agreement.heading =
      degrees > opposite_degrees ? HeadingRelation::kDegrees : HeadingRelation::kOppositeDegrees;
  agreement.heading_share = std::max(degrees, opposite_degrees);
}

}  // namespace

bool moves_in_another_direction(const OdometryAgreement& odometry) {
  constexpr double kLeastConcentration = 0.8;
  return odometry.direction_concentration >= kLeastConcentration &&
         std::abs(odometry.direction_offset_rad) >= kOtherDirection_rad;
}

bool follows_its_heading(const OdometryAgreement& odometry) {
  return odometry.odometry_slip_rad < DEG2RAD(20.0);
}

bool is_sound(const OdometryAgreement& odometry) {
  const bool length_is_right =
      odometry.length_ratio == 0 || (odometry.length_ratio > 0.6 && odometry.length_ratio < 1.6);
  const bool heading_is_right =
      odometry.heading == HeadingRelation::kAgrees || odometry.heading == HeadingRelation::kUnknown;
  return length_is_right && heading_is_right && !odometry.clock_offset;
}

std::vector<std::vector<std::size_t>> tracks_from(const std::vector<std::size_t>& starts,
                                                  std::size_t frames_in_log) {
  std::vector<std::vector<std::size_t>> tracks;
  for (const std::size_t start : starts) {
    std::vector<std::size_t> frames;
    for (std::size_t i = start; i < std::min(start + kFramesInTrack, frames_in_log); ++i) frames.push_back(i);
    tracks.push_back(std::move(frames));
  }
  return tracks;
}

OdometryAgreement check_odometry(const std::vector<FrameMark>& marks,
                                 const std::vector<std::vector<std::size_t>>& tracks,
                                 const ScanLibrary& library) {
  std::vector<Track> followed;
  for (const std::vector<std::size_t>& frames : tracks)
    if (auto track = follow(marks, frames, library)) followed.push_back(std::move(*track));
  OdometryAgreement agreement;
  agreement.tracks = followed.size();
  compare_lengths(followed, agreement);
  compare_turns(followed, agreement);
  if (agreement.heading == HeadingRelation::kNone && turns_anywhere(marks))
    agreement.heading = HeadingRelation::kUnrelated;
  return agreement;
}

OdometryAgreement check_odometry_and_delay(std::vector<FrameMark>& marks,
                                           const std::vector<std::vector<std::size_t>>& tracks,
                                           const ScanLibrary& library) {
  OdometryAgreement agreement = check_odometry(marks, tracks, library);
  if (is_sound(agreement) &&
      (agreement.heading != HeadingRelation::kAgrees || agreement.heading_share > kClearShare))
    return agreement;
  if (!is_sound(agreement)) {
    const auto delay = estimate_scan_delay(marks, agreement.turns);
    if (delay && delay->is_significant()) {
      std::vector<FrameMark> shifted = with_scan_delay(marks, delay->delay_s);
      OdometryAgreement with_delay = check_odometry(shifted, tracks, library);
      if (is_sound(with_delay)) {
        marks = std::move(shifted);
        return with_delay;
      }
    }
  }
  const auto offset = estimate_clock_offset(marks, agreement.turns);
  if (!offset || !offset->is_significant()) return agreement;
  const OdometryAgreement with_offset =
      check_odometry(with_scan_delay(marks, offset->delay_s), tracks, library);
  if (is_sound(with_offset) && with_offset.heading == HeadingRelation::kAgrees &&
      with_offset.heading_share > agreement.heading_share)
    agreement.clock_offset = offset;
  return agreement;
}

}  // namespace psi_slam
