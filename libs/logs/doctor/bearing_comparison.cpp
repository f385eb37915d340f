// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/bearing_comparison.h"

#include <cmath>
#include <utility>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

AlignableScan with_bearings(LaserScan scan, const BearingHypotheses& hypotheses, std::size_t hypothesis) {
  if (const BeamBearings& bearings = hypotheses.bearings_rad[hypothesis]) scan.bearings_rad = bearings;
  return AlignableScan(scan, hypotheses.max_range_m, hypotheses.points);
}

}  // namespace

std::vector<ScanAlignment> align_under(const BearingHypotheses& hypotheses, const LaserScan& reference,
                                       const LaserScan& scan,
                                       const std::vector<mrpt::math::TPose2D>& guesses) {
  std::vector<ScanAlignment> alignments;
  if (reference.ranges_m.size() != hypotheses.beams || scan.ranges_m.size() != hypotheses.beams)
    return alignments;
  for (std::size_t k = 0; k < hypotheses.bearings_rad.size(); ++k)
    alignments.push_back(
        align_scans(with_bearings(reference, hypotheses, k), with_bearings(scan, hypotheses, k), guesses));
  return alignments;
}

void WallDistances::add(const std::vector<ScanAlignment>& alignments) {
  std::vector<double> row;
  for (const ScanAlignment& alignment : alignments) row.push_back(alignment.cost_m);
  distances_m_.push_back(std::move(row));
}

double WallDistances::mean_m(std::size_t hypothesis) const {
  double sum_m = 0;
  for (const std::vector<double>& row : distances_m_) sum_m += row[hypothesis];
  return sum_m / static_cast<double>(distances_m_.size());
}

WallDistances::Excess WallDistances::excess(std::size_t hypothesis, std::size_t other) const {
  Excess excess;
  excess.mean_m = mean_m(hypothesis) - mean_m(other);
  double squares = 0;
  for (const std::vector<double>& row : distances_m_)
    squares += portable::pow(row[hypothesis] - row[other] - excess.mean_m, 2);
  excess.error_m = std::sqrt(squares) / static_cast<double>(distances_m_.size());
  return excess;
}

}  // namespace psi_slam
