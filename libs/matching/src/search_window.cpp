// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/matching/search_window.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace psi_slam {
namespace {

// A quotient that is whole but for rounding stays whole.
int covering_steps(double half_width, double step) {
  return static_cast<int>(std::ceil(half_width / step - 1e-9));
}

}  // namespace

SearchWindow make_search_window(const SearchExtent& extent, double resolution_m, double farthest_point_m) {
  const bool valid = extent.x_m > 0 && extent.y_m > 0 && extent.theta_rad > 0 && resolution_m > 0 &&
                     2 * farthest_point_m > resolution_m && std::isfinite(farthest_point_m);
  if (!valid) {
    std::ostringstream text;
    text << "no search window from half-widths " << extent.x_m << " m, " << extent.y_m << " m, "
         << extent.theta_rad << " rad, resolution " << resolution_m << " m and farthest point "
         << farthest_point_m << " m: all must be positive and the farthest point beyond half a cell";
    throw std::invalid_argument(text.str());
  }
  SearchWindow window;
  window.linear_step_m = resolution_m;
  window.angular_step_rad =
      std::acos(1 - resolution_m * resolution_m / (2 * farthest_point_m * farthest_point_m));
  window.n_x = covering_steps(extent.x_m, resolution_m);
  window.n_y = covering_steps(extent.y_m, resolution_m);
  window.n_theta = covering_steps(extent.theta_rad, window.angular_step_rad);
  return window;
}

}  // namespace psi_slam
