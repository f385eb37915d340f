// SPDX-License-Identifier: BSD-3-Clause
// Pairs of scans of a simulated run, aligned in memory.
#pragma once

#include <cmath>
#include <vector>

#include "logs/doctor/pair_alignment.h"
#include "simulated_run.h"

namespace psi_slam {

struct AlignedRun {
  std::vector<FrameMark> marks;
  std::vector<AlignedPair> pairs;  ///< overlapping_pairs()
};

inline AlignedRun aligned_run(const SimulatedRun& run) {
  AlignedRun aligned;
  std::vector<LaserScan> scans;
  std::vector<const LaserScan*> pointers;
  scans.reserve(run.truth.size());
  for (std::size_t i = 0; i < run.truth.size(); ++i) {
    aligned.marks.push_back(
        {std::llround(1e6 * SimulatedRun::kPeriod_s * static_cast<double>(i)), run.odometry[i]});
    scans.push_back(run.scan(i));
    pointers.push_back(&scans.back());
  }
  const auto pairs = overlapping_pairs(aligned.marks, 0.25, mrpt::DEG2RAD(12.0), 1500);
  ScanLibrary library;
  library.want(pairs);
  library.take(pointers);
  aligned.pairs = align_pairs(aligned.marks, pairs, library);
  return aligned;
}

}  // namespace psi_slam
