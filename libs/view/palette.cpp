// SPDX-License-Identifier: BSD-3-Clause
#include "view/palette.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>

namespace psi_slam {

using mrpt::img::TColor;

TColor matcher_colour(MatcherKind matcher) {
  switch (matcher) {
    case MatcherKind::kCsm:
      return {117, 76, 180};
    case MatcherKind::kCsmGa:
      return {0, 122, 204};
    case MatcherKind::kGa:
      return {0, 145, 90};
  }
  return {};
}

TColor verdict_colour(LoopVerdict verdict) {
  static const std::map<LoopVerdict, TColor> kColours{
      {LoopVerdict::kAccepted, {0, 130, 70}},    {LoopVerdict::kPending, {176, 112, 0}},
      {LoopVerdict::kRefused, {120, 124, 130}},  {LoopVerdict::kSwitchedOff, {196, 30, 40}},
      {LoopVerdict::kNotFound, {160, 164, 170}}, {LoopVerdict::kDeleted, {150, 20, 110}}};
  return kColours.at(verdict);
}

TColor heat_colour(double share) {
  constexpr std::array<std::array<double, 3>, 3> kStops{{{26, 150, 65}, {240, 190, 40}, {200, 20, 30}}};
  const double at = std::clamp(share, 0.0, 1.0) * 2;
  const auto first = static_cast<std::size_t>(std::min(std::floor(at), 1.0));
  const double u = at - static_cast<double>(first);
  const auto mixed = [&](std::size_t channel) {
    const double value = kStops[first][channel] * (1 - u) + kStops[first + 1][channel] * u;
    return static_cast<std::uint8_t>(std::lround(value));
  };
  return {mixed(0), mixed(1), mixed(2)};
}

}  // namespace psi_slam
