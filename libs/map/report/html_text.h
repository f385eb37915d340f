// SPDX-License-Identifier: BSD-3-Clause
// Text for HTML pages: escaping, and numbers in a form for people.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace psi_slam {

/// Escapes text for HTML and XML, between tags or in quoted attributes. Control characters other than newline
/// and tab become '?'.
std::string escape_html(std::string_view text);

/// Returns the bytes in base64 (RFC 4648) with padding.
std::string base64(std::string_view bytes);

/// Returns a count such as "13,631".
std::string grouped(std::size_t count);

/// Returns a number such as "1,234.5", or "–" if it is not finite.
std::string grouped(double value, int decimals);

/// Returns a duration such as "44 min 51 s", "2 h 7 min" or "8.25 s", or "–" if it is not finite.
std::string duration_text(double duration_s);

/// Returns a time in milliseconds with about three digits and without unit: "0.012", "1.53", "15.1", "1,840".
std::string milliseconds_text(double milliseconds);

/// Returns a count and its noun: "1 loop", "3 loops".
std::string counted(std::size_t count, const char* one, const char* many);

}  // namespace psi_slam
