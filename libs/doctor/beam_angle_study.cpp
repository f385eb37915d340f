// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/beam_angle_study.h"

#include <mrpt/core/bits_math.h>
#include <mrpt/math/wrap2pi.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "base/portable_math.h"
#include "doctor/pair_alignment.h"
#include "frames/laser_readings.h"
#include "frames/scan_alignment.h"

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

struct Convention {
  BeamAngles angles;
  BeamBearings bearings_rad;
};

std::vector<Convention> conventions_for(const std::vector<float>& used_rad, double field_of_view_rad) {
  const bool clockwise = used_rad.size() > 1 && used_rad.back() < used_rad.front();
  std::vector<Convention> conventions;
  for (const BeamAngles angles : stated_beam_angles()) {
    if (angles == BeamAngles::kSkipZero && used_rad.size() % 2 != 0) continue;
    std::vector<float> bearings = make_bearings_rad(angles, used_rad.size(), field_of_view_rad);
    if (clockwise) mirror(bearings);
    conventions.push_back({angles, std::make_shared<const std::vector<float>>(std::move(bearings))});
  }
  return conventions;
}

AlignableScan with_bearings(LaserScan scan, const BeamBearings& bearings_rad) {
  scan.bearings_rad = bearings_rad;
  return AlignableScan(scan, kSight_m, kPoints);
}

/// Returns [pair][convention]: the mean distance from points to walls, metres. Skips pairs that some
/// convention does not align reliably.
std::vector<std::vector<double>> distances_m(const std::vector<FrameMark>& marks,
                                             const std::vector<FramePair>& pairs, const ScanLibrary& library,
                                             const std::vector<Convention>& conventions) {
  std::vector<std::vector<double>> rows;
  for (const FramePair& pair : pairs) {
    const LaserScan& first = library.at(pair.first);
    const LaserScan& second = library.at(pair.second);
    const std::size_t beams = conventions.front().bearings_rad->size();
    if (first.ranges_m.size() != beams || second.ranges_m.size() != beams) continue;
    std::vector<double> row;
    for (const Convention& convention : conventions) {
      const ScanAlignment alignment =
          align_scans(with_bearings(first, convention.bearings_rad),
                      with_bearings(second, convention.bearings_rad), odometry_between(marks, pair));
      if (!alignment.is_reliable()) break;
      row.push_back(alignment.cost_m);
    }
    if (row.size() == conventions.size()) rows.push_back(std::move(row));
  }
  return rows;
}

void compare_distances(const std::vector<std::vector<double>>& rows, std::vector<BeamAngleFit>& fits) {
  const auto count = static_cast<double>(rows.size());
  for (std::size_t c = 0; c < fits.size(); ++c)
    for (const std::vector<double>& row : rows) fits[c].mean_distance_m += row[c] / count;
  const auto best =
      static_cast<std::size_t>(std::min_element(fits.begin(), fits.end(),
                                                [](const BeamAngleFit& a, const BeamAngleFit& b) {
                                                  return a.mean_distance_m < b.mean_distance_m;
                                                }) -
                               fits.begin());
  for (std::size_t c = 0; c < fits.size(); ++c) {
    double squares = 0;
    fits[c].worse_by_m = fits[c].mean_distance_m - fits[best].mean_distance_m;
    for (const std::vector<double>& row : rows)
      squares += portable::pow(row[c] - row[best] - fits[c].worse_by_m, 2);
    const double error_m = std::sqrt(squares) / count;
    fits[c].significance = error_m > 0 ? fits[c].worse_by_m / error_m : 0;
    fits[c].ruled_out_by_walls = fits[c].worse_by_m > kWorseFraction * fits[best].mean_distance_m &&
                                 fits[c].significance > kWorseErrors;
  }
}

/// Returns the excess over 360 degrees of the alignments along a full turn, radians. Empty if a pair of scans
/// does not align.
std::optional<double> turn_error_rad(const std::vector<FrameMark>& marks,
                                     const std::vector<double>& headings_rad,
                                     const std::vector<std::size_t>& frames, const ScanLibrary& library,
                                     const BeamBearings& bearings_rad) {
  const auto aligned_turn = [&](std::size_t first, std::size_t second) -> std::optional<double> {
    const LaserScan& a = library.at(first);
    const LaserScan& b = library.at(second);
    if (a.ranges_m.size() != bearings_rad->size() || b.ranges_m.size() != bearings_rad->size())
      return std::nullopt;
    const ScanAlignment alignment =
        align_scans(with_bearings(a, bearings_rad), with_bearings(b, bearings_rad),
                    odometry_between(marks, {first, second}));
    if (alignment.cost_m > 0.06 || alignment.matched_share < 0.6) return std::nullopt;
    return alignment.reference_T_scan.phi;
  };
  double sum_rad = 0;
  for (std::size_t i = 1; i < frames.size(); ++i) {
    const auto turn_rad = aligned_turn(frames[i - 1], frames[i]);
    if (!turn_rad) return std::nullopt;
    const double odometry_rad = headings_rad[frames[i]] - headings_rad[frames[i - 1]];
    sum_rad += odometry_rad + wrapToPi(*turn_rad - odometry_rad);
  }
  const auto closing_rad = aligned_turn(frames.front(), frames.back());
  if (!closing_rad) return std::nullopt;
  return std::abs(sum_rad - *closing_rad) - 2 * M_PI;
}

void compare_full_turns(const std::vector<FrameMark>& marks,
                        const std::vector<std::vector<std::size_t>>& turns, const ScanLibrary& library,
                        const std::vector<Convention>& conventions, BeamAngleStudy& study) {
  const std::vector<double> headings_rad = unwrapped_headings(marks);
  for (const std::vector<std::size_t>& frames : turns) {
    std::vector<double> errors_rad;
    for (const Convention& convention : conventions) {
      const auto error_rad = turn_error_rad(marks, headings_rad, frames, library, convention.bearings_rad);
      if (!error_rad || std::abs(*error_rad) > DEG2RAD(10.0)) break;
      errors_rad.push_back(*error_rad);
    }
    if (errors_rad.size() != conventions.size()) continue;
    ++study.full_turns;
    for (std::size_t c = 0; c < conventions.size(); ++c) study.fits[c].full_turn_error_rad += errors_rad[c];
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
bool has_usual_steps(const Convention& convention) {
  const std::vector<float>& bearings = *convention.bearings_rad;
  if (bearings.size() < 2) return true;
  const double quarters = std::abs(mrpt::RAD2DEG(static_cast<double>(bearings[1] - bearings[0]))) / 0.25;
  return std::abs(quarters - std::round(quarters)) < 0.001;
}

BeamAngles choose(const std::vector<Convention>& conventions, const BeamAngleStudy& study) {
  std::vector<std::size_t> left;
  const auto keep = [&](auto&& is_right) {
    std::vector<std::size_t> kept;
    for (const std::size_t c : left)
      if (is_right(c)) kept.push_back(c);
    if (!kept.empty()) left = kept;
  };
  for (std::size_t c = 0; c < conventions.size(); ++c) left.push_back(c);
  keep([&](std::size_t c) { return !study.fits[c].ruled_out_by_walls; });
  keep([&](std::size_t c) { return !study.fits[c].ruled_out_by_turns; });
  keep([&](std::size_t c) { return has_usual_steps(conventions[c]); });
  const BeamAngles usual = usual_beam_angles(conventions.front().bearings_rad->size());
  const auto chosen = std::min_element(left.begin(), left.end(), [&](std::size_t a, std::size_t b) {
    if (study.knows_heading)
      return std::abs(study.fits[a].laser_heading_rad) < std::abs(study.fits[b].laser_heading_rad);
    return conventions[a].angles == usual && conventions[b].angles != usual;
  });
  return conventions[*chosen].angles;
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
  const std::vector<Convention> conventions = conventions_for(used_rad, field_of_view_rad);
  const auto rows = distances_m(marks, evidence.turning_pairs, library, conventions);
  study.pairs = rows.size();
  if (rows.size() < kFewestPairs) return study;
  for (const Convention& convention : conventions) {
    BeamAngleFit fit;
    fit.angles = convention.angles;
    if (laser_heading_rad)
      fit.laser_heading_rad = *laser_heading_rad - (mean(*convention.bearings_rad) - mean(used_rad));
    study.fits.push_back(fit);
  }
  study.knows_heading = laser_heading_rad.has_value();
  compare_distances(rows, study.fits);
  compare_full_turns(marks, evidence.full_turns, library, conventions, study);
  study.best = choose(conventions, study);
  return study;
}

}  // namespace psi_slam
