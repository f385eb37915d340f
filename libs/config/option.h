// SPDX-License-Identifier: BSD-3-Clause
// The description of one option, bound to a member of a settings struct. Everything that shows, loads or
// saves the option works from this description.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "config/number_range.h"

namespace psi_slam {

enum class OptionType { kFlag, kInteger, kNumber, kChoice, kText };

struct Option {
  std::string section;
  std::string key;   ///< ends in its unit where it has one: "window_x_m", "window_theta_deg"
  std::string unit;  ///< of integers and numbers: "m", "deg", "scans"; "" for pure numbers
  std::string help;  ///< one line
  OptionType type = OptionType::kText;
  NumberRange range;                 ///< of integers and numbers, in `unit`
  bool may_be_auto = false;          ///< the text "auto" stands for the empty std::optional
  std::vector<std::string> choices;  ///< what a choice may be
  std::string default_text;          ///< the member's value when it was described

  /// The member's value now. `assign` of this text changes no bit.
  std::function<std::string()> text;
  /// Whether the text is a value of this option's type and range.
  std::function<bool(std::string_view text)> accepts;
  /// Gives the member the value that the text stands for. Returns false, changing nothing, if it is not
  /// accepted.
  std::function<bool(std::string_view text)> assign;

  std::string name() const { return section + '.' + key; }

  /// What is accepted, to follow "expected": "a number of metres between 0.01 and 20", "true or false".
  std::string expectation() const;

  /// The same in short, for listings: "m, between 0.01 and 20", "true or false", "one of csm, ga".
  std::string values() const;
};

}  // namespace psi_slam
