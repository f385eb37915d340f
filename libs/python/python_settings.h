// SPDX-License-Identifier: BSD-3-Clause
// Settings and edits as Python programs state them.
#pragma once

#include <pybind11/pybind11.h>

#include "session/edit_journal.h"
#include "session/settings.h"

namespace psi_slam {

/// Loads the settings file `config`, unless it is None, and then the dict `settings`, unless it is None:
/// names "section.key" and values of type str, path, int, float, bool, or None for "auto". Throws UserError
/// for unknown names, for values that are not accepted, and for settings that contradict each other.
void load_python_settings(BoundSettings& bound, const pybind11::object& config,
                          const pybind11::object& settings);

/// Returns the edits of a file, whose path is a str or a path, or of a list of lines. None: no edits. Throws
/// UserError for a line that is not an edit.
EditJournal python_edits(const pybind11::object& edits);

}  // namespace psi_slam
