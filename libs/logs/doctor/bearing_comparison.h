// SPDX-License-Identifier: BSD-3-Clause
// Compares how well the scans of a log fit each other if their beams have other bearings.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <vector>

#include "logs/frames/laser_readings.h"
#include "logs/frames/scan_alignment.h"

namespace psi_slam {

/// Bearings that a scan may have. Null: its own.
struct BearingHypotheses {
  std::vector<BeamBearings> bearings_rad;
  std::size_t beams = 0;     ///< of the scans that may have them
  double max_range_m = 30;   ///< of the points that are aligned
  std::size_t points = 200;  ///< maximum number of points of a scan
};

/// Aligns two scans under each hypothesis, see align_scans(). Empty if their numbers of beams differ from
/// those of the hypotheses.
std::vector<ScanAlignment> align_under(const BearingHypotheses& hypotheses, const LaserScan& reference,
                                       const LaserScan& scan,
                                       const std::vector<mrpt::math::TPose2D>& guesses);

/// Mean distances from points to walls under each hypothesis, metres, of pairs of scans.
class WallDistances {
 public:
  void add(const std::vector<ScanAlignment>& alignments);
  std::size_t pairs() const { return distances_m_.size(); }

  /// Returns the mean over all pairs. Needs a pair.
  double mean_m(std::size_t hypothesis) const;

  /// Mean excess of the distances under one hypothesis over those under another, and its standard error.
  struct Excess {
    double mean_m = 0;
    double error_m = 0;
  };
  Excess excess(std::size_t hypothesis, std::size_t other) const;

 private:
  std::vector<std::vector<double>> distances_m_;  // [pair][hypothesis]
};

}  // namespace psi_slam
