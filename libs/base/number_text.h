// SPDX-License-Identifier: BSD-3-Clause
// Numbers as text for files, the same in every locale (printf's decimal point is not).
#pragma once

#include <string>

namespace psi_slam {

/// `value` with that many decimals, at most 20, never in scientific notation: fixed_text(0.5, 3) == "0.500".
/// "nan", "inf" and "-inf" where it is not finite.
std::string fixed_text(double value, int decimals);

/// The shortest decimal text without exponent that reads back as exactly this float.
std::string shortest_text(float value);

/// Returns `value` rounded to at most `max_decimals` decimals, without trailing zeros: trimmed_text(0.5, 4) ==
/// "0.5".
std::string trimmed_text(double value, int max_decimals);

}  // namespace psi_slam
