// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/field_of_view_study.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "logs/doctor/bearing_comparison.h"
#include "logs/frames/laser_readings.h"

namespace psi_slam {
namespace {

using mrpt::DEG2RAD;
using mrpt::math::TPose2D;

constexpr std::size_t kFewestTurningPairs = 15;
constexpr std::size_t kMostTurningPairs = 60;
// The right field of view explains what the wrong one does not.
constexpr double kLeastGain = 0.1;           // of the mean distance to walls, as a share
constexpr double kErrors = 5;                // least difference of the distances, in standard errors
constexpr double kLeastAgreeingShare = 0.7;  // of the turns
// Of a turn. Odometry slips by less, and a wrong field of view shows twice the turn or half of it.
constexpr double kTurnToleranceShare = 0.2;
const double kTurnTolerance_rad = DEG2RAD(1.0);

/// Returns the field of view of evenly spaced bearings, as log.field_of_view_deg states it. 0 if they are not
/// symmetric to one or two beams.
double field_of_view_rad(const std::vector<float>& bearings) {
  if (bearings.size() < 2) return 0;
  const auto first = static_cast<double>(bearings.front());
  const auto last = static_cast<double>(bearings.back());
  const double step_rad = std::abs(last - first) / static_cast<double>(bearings.size() - 1);
  if (std::abs(first + last) > 2 * step_rad) return 0;
  const bool is_open = usual_beam_angles(bearings.size()) == BeamAngles::kLeftOpen;
  return std::abs(last - first) + (is_open ? step_rad : 0);
}

/// Rounds to 0.1 degrees: logs state angles in radians with a few decimals.
double rounded_rad(double angle_rad) {
  return DEG2RAD(std::round(10 * mrpt::RAD2DEG(angle_rad)) / 10);
}

BeamBearings bearings_for(const std::vector<float>& stated, double field_of_view_rad) {
  std::vector<float> bearings =
      make_bearings_rad(usual_beam_angles(stated.size()), stated.size(), field_of_view_rad);
  if (stated.back() < stated.front()) mirror(bearings);
  return std::make_shared<const std::vector<float>>(std::move(bearings));
}

/// Distances to walls and turns of pairs of scans under several fields of view.
struct Alignments {
  WallDistances distances;
  std::vector<double> turn_shares;  ///< [field of view]: fraction of the turns of odometry
};

Alignments align_all(const std::vector<FrameMark>& marks, const std::vector<FramePair>& pairs,
                     const ScanLibrary& library, const BearingHypotheses& hypotheses) {
  Alignments all;
  all.turn_shares.assign(hypotheses.bearings_rad.size(), 0);
  for (const FramePair& pair : pairs) {
    const TPose2D motion = odometry_between(marks, pair);
    const double tolerance_rad = kTurnTolerance_rad + kTurnToleranceShare * std::abs(motion.phi);
    const std::vector<ScanAlignment> alignments =
        align_under(hypotheses, library.at(pair.first), library.at(pair.second),
                    {motion, {motion.x, motion.y, motion.phi / 2}});
    if (alignments.empty()) continue;
    for (std::size_t k = 0; k < alignments.size(); ++k) {
      const double off_rad = mrpt::math::wrapToPi(alignments[k].reference_T_scan.phi - motion.phi);
      if (alignments[k].is_reliable() && std::abs(off_rad) <= tolerance_rad) ++all.turn_shares[k];
    }
    all.distances.add(alignments);
  }
  for (double& share : all.turn_shares)
    share /= static_cast<double>(std::max<std::size_t>(1, all.distances.pairs()));
  return all;
}

/// Returns whether the distances under the field of view `k` are smaller than as stated, beyond doubt.
bool fits_walls_better(const WallDistances& distances, std::size_t k) {
  const auto [better_m, error_m] = distances.excess(0, k);
  return better_m > kLeastGain * distances.mean_m(0) && better_m > kErrors * error_m;
}

}  // namespace

FieldOfViewEvidence choose_field_of_view_evidence(const std::vector<FrameMark>& marks) {
  FieldOfViewEvidence evidence;
  evidence.turning_pairs = pairs_by_turn(marks, DEG2RAD(6.0), DEG2RAD(45.0), 0.5, kMostTurningPairs);
  std::vector<FramePair>& straight = evidence.straight_pairs;
  for (const FramePair& pair : pairs_by_motion(marks, 0.5, DEG2RAD(6.0), marks.size()))
    if (std::abs(odometry_between(marks, pair).phi) < DEG2RAD(6.0)) straight.push_back(pair);
  straight = thinned(straight, kMostTurningPairs);
  return evidence;
}

FieldOfViewStudy study_field_of_view(const std::vector<FrameMark>& marks, const FieldOfViewEvidence& evidence,
                                     const ScanLibrary& library) {
  FieldOfViewStudy study;
  if (evidence.turning_pairs.empty()) return study;
  const std::vector<float>& stated = *library.at(evidence.turning_pairs.front().first).bearings_rad;
  const double stated_rad = field_of_view_rad(stated);
  if (stated_rad <= 0) return study;
  BearingHypotheses hypotheses;
  hypotheses.beams = stated.size();
  for (const double factor : {1.0, 2.0, 0.5}) {
    if (factor * stated_rad > 2 * M_PI + 1e-6) continue;
    const double fov_rad = std::min(rounded_rad(factor * stated_rad), 2 * M_PI);
    study.fits.push_back({fov_rad});
    hypotheses.bearings_rad.push_back(factor == 1 ? nullptr : bearings_for(stated, fov_rad));
  }
  const Alignments turns = align_all(marks, evidence.turning_pairs, library, hypotheses);
  const Alignments straight = align_all(marks, evidence.straight_pairs, library, hypotheses);
  study.turns = turns.distances.pairs();
  study.straight_pairs = straight.distances.pairs();
  if (std::min(study.turns, study.straight_pairs) < kFewestTurningPairs) return {};
  std::size_t best = 0;
  for (std::size_t k = 0; k < study.fits.size(); ++k) {
    study.fits[k].turn_share = turns.turn_shares[k];
    study.fits[k].mean_distance_m = straight.distances.mean_m(k);
    if (study.fits[k].turn_share > study.fits[best].turn_share) best = k;
  }
  if (study.fits[best].turn_share >= kLeastAgreeingShare &&
      study.fits.front().turn_share < 1 - kLeastAgreeingShare && fits_walls_better(straight.distances, best))
    study.best = best;
  return study;
}

}  // namespace psi_slam
