// SPDX-License-Identifier: BSD-3-Clause
// A line of an edit file, see EditJournal.
#pragma once

#include <string>
#include <string_view>

#include "session/edit_journal.h"

namespace psi_slam {

/// Without a line end.
std::string edit_line(const TimedEdit& edit);

/// Throws UserError, a sentence without the place, where the line is no edit. It holds no comment.
TimedEdit parse_edit_line(std::string_view line);

}  // namespace psi_slam
