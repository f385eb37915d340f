// SPDX-License-Identifier: BSD-3-Clause
// Converts numbers to text and back, independently of the locale.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace psi_slam {

/// Returns `value` with `decimals` decimals (at most 20) and never in scientific notation: fixed_text(0.5, 3)
/// == "0.500". Returns "nan", "inf" or "-inf" if `value` is not finite.
std::string fixed_text(double value, int decimals);

/// The shortest decimal text without exponent that reads back as exactly this float.
std::string shortest_text(float value);

/// Reads a text that is a finite decimal number and nothing else. Empty for "12abc", "", "nan", "inf",
/// "1e999", "0x10".
std::optional<double> parse_number(std::string_view text);

/// Parses a whole number from 0 to `maximum`. Empty for any other text.
std::optional<std::uint32_t> parse_whole_number(std::string_view text, std::uint32_t maximum);

/// Decimal text with the fewest digits that parse_number() reads as exactly `value`. The text has an exponent
/// only below 1e-5 and from 1e15 on. "nan", "inf" or "-inf" if `value` is not finite.
std::string exact_text(double value);

/// Reads an angle in degrees and returns the nearest double in radians. Empty for a text that parse_number()
/// does not read.
std::optional<double> parse_degrees(std::string_view text);

/// Text of an angle in degrees, with the fewest decimals from which parse_degrees() restores exactly
/// `radians`.
std::string exact_degrees_text(double radians);

/// Returns `value` rounded to at most `max_decimals` decimals, without trailing zeros: trimmed_text(0.5, 4)
/// == "0.5".
std::string trimmed_text(double value, int max_decimals);

/// Returns a duration as minutes and seconds, from one hour on with hours: "0:07", "12:30", "1:02:03".
std::string minutes_text(double duration_s);

/// Returns a count and its noun: "1 loop", "3 loops".
std::string counted(std::size_t count, const std::string& noun);

}  // namespace psi_slam
