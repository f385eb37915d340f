// SPDX-License-Identifier: BSD-3-Clause
#include "exports/csv_text.h"

#include "base/number_text.h"

namespace psi_slam {

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string csv_pose(const mrpt::math::TPose2D& pose) {
  return fixed_text(pose.x, 6) + ',' + fixed_text(pose.y, 6) + ',' + fixed_text(pose.phi, 6);
}

}  // namespace psi_slam
