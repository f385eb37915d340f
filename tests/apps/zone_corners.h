// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/CMatrixDynamic.h>
#include <mrpt/math/TPoint2D.h>

#include <string>
#include <vector>

namespace psi_slam {

/// Returns the corners of the zones in zones.txt of a results folder, in the order of the zones.
inline std::vector<mrpt::math::TPoint2D> corners_of_zones(const std::string& folder) {
  mrpt::math::CMatrixDouble table;
  table.loadFromTextFile(folder + "/zones.txt");
  std::vector<mrpt::math::TPoint2D> corners;
  for (int row = 0; row < table.rows(); ++row) corners.emplace_back(table(row, 3), table(row, 4));
  return corners;
}

}  // namespace psi_slam
