// SPDX-License-Identifier: BSD-3-Clause
#include "matching/refinement_kernel.h"

#include <mrpt/math/TPose2D.h>

#include "base/portable_math.h"
#include "matching/scan_points.h"
#include "matching/score_grid.h"

namespace psi_slam {

PlacedScan placed(const ScoreGrid& grid, const ScanPoints& scan, const mrpt::math::TPose2D& map_T_robot) {
  static_assert(sizeof(mrpt::math::TPoint2Df) == 2 * sizeof(float));
  static_assert(ScoreLevel::kMargin >= 9, "the kernel reads nine cells beyond the grid");
  PlacedScan placed;
  placed.cells = grid.finest().cell(0, 0);
  placed.row_bytes = grid.finest().row_bytes();
  placed.width = grid.finest().width();
  placed.height = grid.finest().height();
  placed.cells_per_m = 1 / grid.resolution_m();
  placed.x_cells = (map_T_robot.x - grid.origin_x_m()) * placed.cells_per_m - 0.5;
  placed.y_cells = (map_T_robot.y - grid.origin_y_m()) * placed.cells_per_m - 0.5;
  placed.cosine = portable::cos(map_T_robot.phi);
  placed.sine = portable::sin(map_T_robot.phi);
  placed.count = scan.points.size();
  if (!scan.points.empty()) placed.points = &scan.points.front().x;
  if (!scan.normals.empty()) placed.normals = &scan.normals.front().x;
  return placed;
}

RefinementKernel refinement_kernel_for(InstructionSet set) {
  if (!can_use(set)) return nullptr;
#ifdef PSI_SLAM_X86_KERNELS
  if (set == InstructionSet::kAvx512) return refinement_kernel_avx512();
#endif
  return refinement_kernel_baseline();
}

RefinementKernel refinement_kernel() {
  static const RefinementKernel kernel = refinement_kernel_for(widest_instruction_set());
  return kernel;
}

}  // namespace psi_slam
