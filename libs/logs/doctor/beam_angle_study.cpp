// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/beam_angle_study.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "logs/doctor/bearing_comparison.h"
#include "logs/doctor/pair_alignment.h"
#include "logs/frames/laser_readings.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::wrapToPi;

constexpr std::size_t kFewestPairs = 20;
constexpr double kSight_m = 20;  // maximum range of the points used
constexpr std::size_t kPoints = 400;
// The walls rule out a convention if its mean distance to walls exceeds the smallest mean distance by more
// than both limits.
constexpr double kWorseFraction = 0.004;  // as a fraction of the smallest distance
constexpr double kWorseErrors = 5;        // in standard errors
const double kTurnError_rad = DEG2RAD(1.0);

/// Bearings of a convention and its name.
struct Conventions : BearingHypotheses {
  std::vector<BeamAngles> angles;
};

Conventions conventions_for(const std::vector<float>& used_rad, double field_of_view_rad) {
  const bool clockwise = used_rad.size() > 1 && used_rad.back() < used_rad.front();
  Conventions conventions;
  conventions.beams = used_rad.size();
  conventions.max_range_m = kSight_m;
  conventions.points = kPoints;
  for (const BeamAngles angles : stated_beam_angles()) {
    if (angles == BeamAngles::kSkipZero && used_rad.size() % 2 != 0) continue;
    std::vector<float> bearings = make_bearings_rad(angles, used_rad.size(), field_of_view_rad);
    if (clockwise) mirror(bearings);
    conventions.angles.push_back(angles);
    conventions.bearings_rad.push_back(std::make_shared<const std::vector<float>>(std::move(bearings)));
  }
  return conventions;
}

/// Returns the distances to walls of the pairs that all conventions align reliably.
WallDistances distances_of(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                           const ScanLibrary& library, const Conventions& conventions) {
  WallDistances distances;
  for (const FramePair& pair : pairs) {
    const std::vector<ScanAlignment> alignments = align_under(
        conventions, library.at(pair.first), library.at(pair.second), {odometry_between(marks, pair)});
    if (!alignments.empty() &&
        std::all_of(alignments.begin(), alignments.end(),
                    [](const ScanAlignment& alignment) { return alignment.is_reliable(); }))
      distances.add(alignments);
  }
  return distances;
}

void compare_distances(const WallDistances& distances, std::vector<BeamAngleFit>& fits) {
  std::size_t best = 0;
  for (std::size_t c = 0; c < fits.size(); ++c) {
    fits[c].mean_distance_m = distances.mean_m(c);
    if (fits[c].mean_distance_m < fits[best].mean_distance_m) best = c;
  }
  for (std::size_t c = 0; c < fits.size(); ++c) {
    const auto [worse_by_m, error_m] = distances.excess(c, best);
    fits[c].worse_by_m = worse_by_m;
    fits[c].significance = error_m > 0 ? worse_by_m / error_m : 0;
    fits[c].ruled_out_by_walls =
        worse_by_m > kWorseFraction * fits[best].mean_distance_m && fits[c].significance > kWorseErrors;
  }
}

/// Returns the excess over 360 degrees of the alignments along a full turn under each convention, radians.
/// Empty if a pair of scans does not align.
std::vector<double> turn_errors_rad(const std::vector<FrameMark>& marks,
                                    const std::vector<double>& headings_rad,
                                    const std::vector<std::size_t>& frames, const ScanLibrary& library,
                                    const Conventions& conventions) {
  std::vector<double> sums_rad(conventions.angles.size(), 0);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const bool is_closing = i + 1 == frames.size();
    const std::size_t first = is_closing ? frames.front() : frames[i];
    const std::size_t second = is_closing ? frames.back() : frames[i + 1];
    const std::vector<ScanAlignment> alignments = align_under(
        conventions, library.at(first), library.at(second), {odometry_between(marks, {first, second})});
    if (alignments.empty()) return {};
    const double odometry_rad = headings_rad[second] - headings_rad[first];
    for (std::size_t c = 0; c < alignments.size(); ++c) {
      if (alignments[c].cost_m > 0.06 || alignments[c].matched_share < 0.6) return {};
      const double turn_rad = alignments[c].reference_T_scan.phi;
      if (is_closing)
        sums_rad[c] = std::abs(sums_rad[c] - turn_rad) - 2 * M_PI;
      else
        sums_rad[c] += odometry_rad + wrapToPi(turn_rad - odometry_rad);
    }
  }
  return sums_rad;
}

void compare_full_turns(const std::vector<FrameMark>& marks,
                        const std::vector<std::vector<std::size_t>>& turns, const ScanLibrary& library,
                        const Conventions& conventions, BeamAngleStudy& study) {
  const std::vector<double> headings_rad = unwrapped_headings(marks);
  for (const std::vector<std::size_t>& frames : turns) {
    const std::vector<double> errors_rad = turn_errors_rad(marks, headings_rad, frames, library, conventions);
    if (errors_rad.empty() || std::any_of(errors_rad.begin(), errors_rad.end(), [](double error_rad) {
          return std::abs(error_rad) > DEG2RAD(10.0);
        }))
      continue;
    ++study.full_turns;
    for (std::size_t c = 0; c < errors_rad.size(); ++c) study.fits[c].full_turn_error_rad += errors_rad[c];
  }
  if (study.full_turns == 0) return;
  double least_rad = INFINITY;
  for (BeamAngleFit& fit : study.fits) {
    fit.full_turn_error_rad /= static_cast<double>(study.full_turns);
    least_rad = std::min(least_rad, std::abs(fit.full_turn_error_rad));
  }
  for (BeamAngleFit& fit : study.fits)
    fit.ruled_out_by_turns = std::abs(fit.full_turn_error_rad) > least_rad + kTurnError_rad;
}

double mean(const std::vector<float>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

/// Returns whether the step between beams is a multiple of 0.25 degrees, as for most lasers.
bool has_usual_steps(const std::vector<float>& bearings) {
  if (bearings.size() < 2) return true;
  const double quarters = std::abs(mrpt::RAD2DEG(static_cast<double>(bearings[1] - bearings[0]))) / 0.25;
  return std::abs(quarters - std::round(quarters)) < 0.001;
}

BeamAngles choose(const Conventions& conventions, const BeamAngleStudy& study) {
  std::vector<std::size_t> left;
  const auto keep = [&](auto&& is_right) {
    std::vector<std::size_t> kept;
    for (const std::size_t c : left)
      if (is_right(c)) kept.push_back(c);
    if (!kept.empty()) left = kept;
  };
  for (std::size_t c = 0; c < conventions.angles.size(); ++c) left.push_back(c);
  keep([&](std::size_t c) { return !study.fits[c].ruled_out_by_walls; });
  keep([&](std::size_t c) { return !study.fits[c].ruled_out_by_turns; });
  keep([&](std::size_t c) { return has_usual_steps(*conventions.bearings_rad[c]); });
  const BeamAngles usual = usual_beam_angles(conventions.beams);
  const auto chosen = std::min_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
    if (study.knows_heading)
      return std::abs(study.fits[a].laser_heading_rad) < std::abs(study.fits[b].laser_heading_rad);
    return conventions.angles[a] == usual && conventions.angles[b] != usual;
  });
  return conventions.angles[*chosen];
}

}  // namespace

BeamAngleEvidence choose_beam_angle_evidence(const std::vector<FrameMark>& marks) {
  return {pairs_by_turn(marks, DEG2RAD(10.0), DEG2RAD(45.0), 0.5, 250),
          full_turns(marks, DEG2RAD(25.0), 1.5, 8)};
}

BeamAngleStudy study_beam_angles(const std::vector<FrameMark>& marks, const BeamAngleEvidence& evidence,
                                 const ScanLibrary& library, const std::vector<float>& used_rad,
                                 double field_of_view_rad, std::optional<double> laser_heading_rad) {
  BeamAngleStudy study;
  if (used_rad.size() < 2) return study;
  const Conventions conventions = conventions_for(used_rad, field_of_view_rad);
  const WallDistances distances = distances_of(marks, evidence.turning_pairs, library, conventions);
  study.pairs = distances.pairs();
  if (study.pairs < kFewestPairs) return study;
  for (std::size_t c = 0; c < conventions.angles.size(); ++c) {
    BeamAngleFit fit;
    fit.angles = conventions.angles[c];
    if (laser_heading_rad)
      fit.laser_heading_rad = *laser_heading_rad - (mean(*conventions.bearings_rad[c]) - mean(used_rad));
    study.fits.push_back(fit);
  }
  study.knows_heading = laser_heading_rad.has_value();
  compare_distances(distances, study.fits);
  compare_full_turns(marks, evidence.full_turns, library, conventions, study);
  study.best = choose(conventions, study);
  return study;
}

}  // namespace psi_slam
