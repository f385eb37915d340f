// SPDX-License-Identifier: BSD-3-Clause
#include "matching/search_window.h"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "base/portable_math.h"

namespace psi_slam {
namespace {

constexpr double kMaxSteps = 1e6;  // more than any search needs; fits an int

// Returns the number of steps that cover a half-width, rounded up. The tolerance keeps rounding errors from
// adding a step.
double covering_steps(double half_width, double step) {
  return std::ceil(half_width / step - 1e-9);
}

bool countable(double steps) {
  return steps >= 0 && steps <= kMaxSteps;  // false for NaN
}

}  // namespace

SearchWindow make_search_window(const SearchExtent& extent, double resolution_m, double farthest_point_m) {
  const bool positive = extent.x_m > 0 && extent.y_m > 0 && extent.theta_rad > 0 && resolution_m > 0 &&
                        2 * farthest_point_m > resolution_m;
  const double angular_step_rad =
      portable::acos(1 - resolution_m * resolution_m / (2 * farthest_point_m * farthest_point_m));
  const double n_x = covering_steps(extent.x_m, resolution_m);
  const double n_y = covering_steps(extent.y_m, resolution_m);
  const double n_theta = covering_steps(extent.theta_rad, angular_step_rad);
  if (!positive || !countable(n_x) || !countable(n_y) || !countable(n_theta)) {
    std::ostringstream text;
    text << "no search window from half-widths " << extent.x_m << " m, " << extent.y_m << " m, "
         << extent.theta_rad << " rad, resolution " << resolution_m << " m and farthest point "
         << farthest_point_m
         << " m: expected positive values, a farthest point beyond half a cell, and at most a million steps "
         << "per half-width";
    throw std::invalid_argument(text.str());
  }
  SearchWindow window;
  window.linear_step_m = resolution_m;
  window.angular_step_rad = angular_step_rad;
  window.n_x = static_cast<int>(n_x);
  window.n_y = static_cast<int>(n_y);
  window.n_theta = static_cast<int>(n_theta);
  return window;
}

}  // namespace psi_slam
