// SPDX-License-Identifier: BSD-3-Clause
// The settings of a session that is resumed: what shaped its map is kept, what only writes the map may
// change.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

#include "psi_slam/session/bound_settings.h"
#include "psi_slam/session/session_recording.h"

namespace psi_slam {

/// Takes all settings of a recording, which was read from `file`. Returns the names of those that this
/// program no longer knows: they are left out. Throws UserError for a value that it does not accept.
std::vector<std::string> load_recorded(BoundSettings& bound, const SessionFacts& facts,
                                       const std::filesystem::path& file);

/// The options, by name, that a resumed session cannot change: all but [map], [localization] and
/// run.threads.
std::map<std::string, std::string> kept_settings(const OptionTable& table);

/// Throws UserError, naming the option, when one of those has another value now than in the session `file`.
void require_kept(const std::map<std::string, std::string>& kept, const OptionTable& table,
                  const std::filesystem::path& file);

}  // namespace psi_slam
