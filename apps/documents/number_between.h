// SPDX-License-Identifier: BSD-3-Clause
// Check of a number on the command line.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

namespace psi_slam {

/// Check that an option is a number from `least` to `most`. Unlike CLI::Range, it refuses NaN.
inline CLI::Validator number_between(double least, double most) {
  const auto check = [=](const std::string& text) -> std::string {
    double number = 0;
    if (CLI::detail::lexical_cast(text, number) && number >= least && number <= most) return "";
    return "Value " + text + " not in range " + std::to_string(least) + " to " + std::to_string(most);
  };
  return {check, CLI::Range(least, most).get_description()};
}

}  // namespace psi_slam
