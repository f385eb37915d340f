// SPDX-License-Identifier: BSD-3-Clause
// The settings of a session that is resumed: what shaped its map is kept, what only writes the map may
// change.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "session/session_recording.h"
#include "session/settings.h"

namespace psi_slam {

/// Takes all settings of a recording, which was read from `file`. Returns a sentence, without its full stop,
/// for each that this program no longer knows: they are left out. Throws UserError for a value that it does
/// not accept.
std::vector<std::string> load_recorded(BoundSettings& bound, const SessionFacts& facts,
                                       const std::filesystem::path& file);

/// That another version of the program made it, which may have mapped it otherwise; none where this one did.
std::optional<std::string> other_version_text(const std::filesystem::path& file, const SessionFacts& facts);

/// The options, by name, that a resumed session cannot change: all but [map], [localization] and
/// run.threads.
std::map<std::string, std::string> kept_settings(const OptionTable& table);

struct ChangedSetting {
  std::string name;
  std::string before;
  std::string now;
};

/// Those of `kept` that have another value in `table`, in the order of their names.
std::vector<ChangedSetting> changed_settings(const std::map<std::string, std::string>& kept,
                                             const OptionTable& table);

/// What is to be known of a session that is mapped with other settings than its own, as one sentence without
/// its full stop that names the first of them; none where those that shape the map are the same.
std::optional<std::string> changed_settings_text(const std::filesystem::path& file, const SessionFacts& facts,
                                                 const OptionTable& table);

/// Throws UserError, naming the option, when one of those has another value now than in the session `file`.
void require_kept(const std::map<std::string, std::string>& kept, const OptionTable& table,
                  const std::filesystem::path& file);

}  // namespace psi_slam
