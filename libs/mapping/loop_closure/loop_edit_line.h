// SPDX-License-Identifier: BSD-3-Clause
// Edits of loops as lines of a file of edits. EditJournal describes the file.
#pragma once

#include <array>
#include <string>
#include <utility>

#include "psi_slam/loop_record.h"

namespace psi_slam {

/// First words of the lines, with the kinds of edits that they state.
inline constexpr std::array<std::pair<const char*, LoopEdit::Kind>, 4> kLoopEditVerbs{
    {{"delete", LoopEdit::Kind::kDelete},
     {"force", LoopEdit::Kind::kForce},
     {"match", LoopEdit::Kind::kMatch},
     {"restore", LoopEdit::Kind::kRestore}}};

/// Returns the line of an edit without its time and without line end:
/// "match scan=812 local_map=14 matcher=csm".
std::string loop_edit_line(const LoopEdit& edit);

}  // namespace psi_slam
