// SPDX-License-Identifier: BSD-3-Clause
// The inner loop of refine(): compares all points of a scan with the score grid at one pose, and sums what a
// Gauss-Newton step needs. The kernel for the widest instruction set of the machine is chosen at run time.
// All kernels do the same operations in the same order, so they give the same bytes.
#pragma once

#include <cstddef>
#include <cstdint>

#include "base/instruction_set.h"

namespace mrpt::math {
struct TPose2D;
}

namespace psi_slam {

// Only declared, because the kernels must not compile inline functions of other headers.
class ScoreGrid;
struct ScanPoints;

/// A scan at one pose in a score grid. The robot's position is counted in cells from the centre of cell
/// (0, 0).
struct PlacedScan {
  const std::uint8_t* cells = nullptr;  ///< cell (0, 0) of a level with a margin of ScoreLevel::kMargin zeros
  std::ptrdiff_t row_bytes = 0;
  int width = 0;  ///< of the level, in cells
  int height = 0;
  double cells_per_m = 0;
  double x_cells = 0;
  double y_cells = 0;
  double cosine = 1;  ///< of the robot's heading
  double sine = 0;
  const float* points = nullptr;   ///< x and y of each point in the robot's frame, metres
  const float* normals = nullptr;  ///< x and y of each normal, see ScanPoints::normals; null if unknown
  std::size_t count = 0;           ///< number of points
};

/// Places a scan at a pose of the robot. The result points into the finest level of the grid and into the
/// scan.
PlacedScan placed(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot);

/// Sums over the points. M is the interpolated score of a point, and (x, y, phi) its derivatives by the pose,
/// in 1/m and 1/rad. On a straight surface, only the slope along its normal counts: a point does not
/// determine the position along its surface. Cells outside the level have the score 0.
struct ScoreSums {
  double squares = 0;                                                ///< of (1 - M)^2
  double scores = 0;                                                 ///< of M
  double xx = 0, xy = 0, yy = 0, x_phi = 0, y_phi = 0, phi_phi = 0;  ///< of products of derivatives
  double x = 0, y = 0, phi = 0;                                      ///< of derivative * (1 - M)
};

using RefinementKernel = ScoreSums (*)(const PlacedScan& scan);

/// Returns the fastest kernel that this machine can use.
RefinementKernel refinement_kernel();

/// Returns the kernel for one instruction set; null if this machine cannot use that set. AVX2 has that of the
/// baseline, because GCC 12 makes a slower one for it. For tests.
RefinementKernel refinement_kernel_for(InstructionSet set);

// Each kernel has its own translation unit, compiled with the flags of its instruction set.
RefinementKernel refinement_kernel_baseline();
RefinementKernel refinement_kernel_avx512();

}  // namespace psi_slam
