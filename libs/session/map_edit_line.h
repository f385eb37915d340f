// SPDX-License-Identifier: BSD-3-Clause
// Lines of edit files that edit the drawn map; see edit_journal.h.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include "map/rendering/map_edits.h"

namespace psi_slam {

/// First words of the lines.
inline constexpr std::array<std::pair<const char*, MapEdit::Kind>, 6> kMapEditVerbs{
    {{"erase", MapEdit::Kind::kErase},
     {"unknown", MapEdit::Kind::kUnknown},
     {"wall", MapEdit::Kind::kWall},
     {"crop", MapEdit::Kind::kCrop},
     {"keep_out", MapEdit::Kind::kKeepOut},
     {"slow", MapEdit::Kind::kSlow}}};

/// Parses a line without comment. Empty if its first word is none of kMapEditVerbs. Throws UserError, without
/// file and line, if the rest of the line is wrong.
std::optional<MapEdit> parse_map_edit_line(std::string_view line);

/// Returns the line of an edit, without line end. Parsing it restores the edit bit for bit.
std::string map_edit_line(const MapEdit& edit);

}  // namespace psi_slam
