// SPDX-License-Identifier: BSD-3-Clause
// Lines of a file of edits that state what is known from outside, see edit_journal.h.
#pragma once

#include <array>
#include <string>
#include <string_view>

#include "psi_slam/fixed_knowledge.h"

namespace psi_slam {

/// Parses a line, without comment, and adds its content to `knowledge`. `place` is the file and the line, for
/// messages. Returns false if the line begins with another verb. Throws UserError, without file and line, if
/// the line is malformed.
bool parse_knowledge_line(std::string_view line, const std::string& place, FixedKnowledge& knowledge);

/// Returns the lines that parse_knowledge_line() reads, each with a line end. They lack the sources.
std::string knowledge_lines(const FixedKnowledge& knowledge);

/// Verbs of these lines.
inline constexpr std::array<const char*, 3> kKnowledgeVerbs{"pose", "tag", "seen"};

/// Throws UserError if a tag has two different places.
void check_tags(const FixedKnowledge& knowledge);

}  // namespace psi_slam
