// SPDX-License-Identifier: BSD-3-Clause
// One line of an edit file; see EditJournal.
#pragma once

#include <string>
#include <string_view>

#include "session/edit_journal.h"

namespace psi_slam {

/// Text of an edit, without line end.
std::string edit_line(const TimedEdit& edit);

/// Parses a line without comment. Throws UserError, without file and line, if the line is no edit.
TimedEdit parse_edit_line(std::string_view line);

}  // namespace psi_slam
