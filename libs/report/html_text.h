// SPDX-License-Identifier: BSD-3-Clause
// Text for pages: escaping, and numbers as a person reads them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace psi_slam {

/// Text for HTML and XML, between tags or within quoted attributes. Control characters become '?'.
std::string escape_html(std::string_view text);

/// RFC 4648, with padding.
std::string base64(std::string_view bytes);

/// "13,631".
std::string grouped(std::int64_t number);

/// "1,234.5"; "–" where the value is not finite.
std::string grouped(double value, int decimals);

/// "44 min 51 s", "2 h 7 min", "8.25 s".
std::string duration_text(double duration_s);

/// With about three digits: "0.012", "1.53", "15.1", "1,840".
std::string milliseconds_text(double milliseconds);

/// "1 loop", "3 loops".
std::string counted(std::size_t count, const char* one, const char* many);

}  // namespace psi_slam
