// SPDX-License-Identifier: BSD-3-Clause
#include "start_pose.h"

#include <mrpt/math/wrap2pi.h>

#include <array>
#include <locale>
#include <sstream>

#include "base/degrees.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

mrpt::math::TPose2D parse_start(const std::string& text) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  std::array<double, 3> numbers{};
  char comma = ',';
  for (std::size_t i = 0; i < numbers.size(); ++i)
    if (!((i == 0 || words >> comma) && comma == ',' && words >> numbers[i]))
      throw UserError("--start " + text + ": expected X,Y,YAW_DEG, as in 12.5,-3,90");
  if (words >> comma) throw UserError("--start " + text + ": expected three numbers, X,Y,YAW_DEG");
  return {numbers[0], numbers[1], mrpt::math::wrapToPi(numbers[2] * radians_from_degrees(1))};
}

}  // namespace psi_slam
