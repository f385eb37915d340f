// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text and back without losing a bit, the same in every locale.
//
// Angles are degrees in text and radians in memory. Not every double of radians is the product of a double of
// degrees, so that conversion goes through long double and the text gets as many digits as it takes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace psi_slam {

/// A finite decimal number and nothing else: empty for "12abc", "", "nan", "inf", "1e999", "0x10".
std::optional<double> parse_number(std::string_view text);

/// The shortest decimal text that parse_number() reads as exactly `value`; "nan", "inf", "-inf" if not
/// finite.
std::string exact_text(double value);

/// Radians, correctly rounded, of a text in degrees; empty where parse_number() is.
std::optional<double> parse_degrees(std::string_view text);

/// The text with the fewest decimals that parse_degrees() reads as exactly `radians`.
std::string exact_degrees_text(double radians);

}  // namespace psi_slam
