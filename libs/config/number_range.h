// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

namespace psi_slam {

/// An end of a range of numbers.
struct RangeEnd {
  double value = 0;
  bool inclusive = true;
};

/// The numbers that an option takes: at_least(0), above(0).at_most(20), at_least(0).below(360), any_number().
/// NaN and the infinities are in no range.
struct NumberRange {
  std::optional<RangeEnd> min;
  std::optional<RangeEnd> max;

  NumberRange at_most(double value) const { return {min, RangeEnd{value, true}}; }
  NumberRange below(double value) const { return {min, RangeEnd{value, false}}; }

  bool contains(double value) const;

  /// "between 0.01 and 20", "0 or more", "above 0 and at most 20", …; "" when every number is in the range.
  std::string words() const;
};

inline NumberRange any_number() {
  return {};
}
inline NumberRange at_least(double value) {
  return {RangeEnd{value, true}, {}};
}
inline NumberRange above(double value) {
  return {RangeEnd{value, false}, {}};
}
inline NumberRange between(double min, double max) {
  return at_least(min).at_most(max);
}

}  // namespace psi_slam
