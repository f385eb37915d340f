// SPDX-License-Identifier: BSD-3-Clause
// The description of one option, bound to a member of a settings struct. All code that shows, loads or saves
// the option uses this description.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

struct RangeEnd {
  double value = 0;
  bool inclusive = true;
};

/// The numbers that an option accepts: at_least(0), above(0).at_most(20), at_least(0).below(360),
/// any_number(). No range contains NaN or an infinity.
struct NumberRange {
  std::optional<RangeEnd> min;
  std::optional<RangeEnd> max;

  NumberRange at_most(double value) const { return {min, RangeEnd{value, true}}; }
  NumberRange below(double value) const { return {min, RangeEnd{value, false}}; }

  bool contains(double value) const;

  /// "between 0.01 and 20", "0 or more", "above 0 and at most 20", …; "" for any_number().
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

enum class OptionType { kFlag, kInteger, kNumber, kChoice, kText };

struct Option {
  std::string section;
  std::string key;   ///< ends in its unit if it has one: "window_x_m", "window_theta_deg"
  std::string unit;  ///< of integers and numbers: "m", "deg", "scans"; "" for pure numbers
  std::string help;  ///< one line
  OptionType type = OptionType::kText;
  NumberRange range;                 ///< of integers and numbers, in `unit`
  bool may_be_auto = false;          ///< the text "auto" means the empty std::optional
  std::vector<std::string> choices;  ///< accepted texts of a choice
  std::string default_text;          ///< the member's value when the option was described

  /// Returns the member's value as text. Assigning this text changes no bit.
  std::function<std::string()> text;
  /// Whether the text is a value of this option's type and range.
  std::function<bool(std::string_view text)> accepts;
  /// Sets the member to the value of the text. Returns false, and changes nothing, if it is not accepted.
  std::function<bool(std::string_view text)> assign;

  std::string name() const { return section + '.' + key; }

  /// The accepted values in words, to follow "expected": "a number of metres between 0.01 and 20".
  std::string expectation() const;

  /// The accepted values in short, for listings: "m, between 0.01 and 20", "true or false", "one of csm, ga".
  std::string values() const;
};

}  // namespace psi_slam
