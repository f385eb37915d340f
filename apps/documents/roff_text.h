// SPDX-License-Identifier: BSD-3-Clause
// Text for manual pages, in the language of troff.
#pragma once

#include <string>
#include <string_view>

namespace psi_slam {

/// Plain text of one or more lines as it is to be read: what troff would take for its own is escaped.
std::string roff_text(std::string_view text);

/// Between \fB and \fR: as it is to be typed.
std::string roff_bold(std::string_view text);

/// Between \fI and \fR: what is to be replaced.
std::string roff_italic(std::string_view text);

/// ".SH NAME", with the line's end.
std::string roff_section(std::string_view title);

/// A paragraph with a hanging tag; both are troff already.
std::string roff_item(const std::string& tag, const std::string& text);

/// Lines shown as they are, indented.
std::string roff_example(std::string_view text);

}  // namespace psi_slam
