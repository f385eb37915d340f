// SPDX-License-Identifier: BSD-3-Clause
// Settings of a session that is resumed. Settings that shaped its map are kept; settings that only affect
// output files may change.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "session/session_recording.h"
#include "session/settings.h"

namespace psi_slam {

/// Loads all settings of the recording that was read from `file`. Ignores obsolete options and returns a
/// warning that names them, as a sentence without full stop. Returns nothing if there are none. Accepts old
/// names of options without warning. Throws UserError for an invalid value.
std::vector<std::string> load_recorded(BoundSettings& bound, const SessionFacts& facts,
                                       const std::filesystem::path& file);

/// Returns a warning if another version of the program recorded the session; empty if this version did.
std::optional<std::string> other_version_text(const std::filesystem::path& file, const SessionFacts& facts);

/// Returns the values of the options that a resumed session cannot change, by name: all except [map],
/// [localization], [live] and run.threads.
std::map<std::string, std::string> kept_settings(const OptionTable& table);

/// Returns a warning if a session is mapped with other settings than its own: a sentence without full stop
/// that names the first changed settings. Empty if all settings that shape the map are equal.
std::optional<std::string> changed_settings_text(const std::filesystem::path& file, const SessionFacts& facts,
                                                 const OptionTable& table);

/// Throws UserError, naming the option, if one of the kept settings of the session `file` has changed.
void require_kept(const std::map<std::string, std::string>& kept, const OptionTable& table,
                  const std::filesystem::path& file);

}  // namespace psi_slam
