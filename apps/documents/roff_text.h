// SPDX-License-Identifier: BSD-3-Clause
// Text of manual pages in the language of troff.
#pragma once

#include <string>
#include <string_view>

namespace psi_slam {

/// Plain text of one or more lines, with the characters that troff interprets escaped.
std::string roff_text(std::string_view text);

/// Bold text, which the user types as it is.
std::string roff_bold(std::string_view text);

/// Italic text, which the user replaces.
std::string roff_italic(std::string_view text);

/// ".SH TITLE" and a line end.
std::string roff_section(std::string_view title);

/// A paragraph with a hanging tag. `tag` and `text` are in troff already.
std::string roff_item(const std::string& tag, const std::string& text);

/// Indented lines that are not filled.
std::string roff_example(std::string_view text);

}  // namespace psi_slam
