// SPDX-License-Identifier: BSD-3-Clause
// Settings together with the table that describes them: what programs load, override, show and edit.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "config/option_table.h"
#include "session/settings.h"

namespace psi_slam {

/// Settings bound to their table: the two stay where they are.
struct BoundSettings {
  BoundSettings() { describe(table, settings); }
  BoundSettings(const BoundSettings&) = delete;
  BoundSettings& operator=(const BoundSettings&) = delete;

  /// Takes the values of a file, unless its name is empty, and then "section.key=value" of the command line,
  /// in the order given. Throws UserError for what cannot be read or is not accepted; whether the values go
  /// together, check() says.
  void load(const std::filesystem::path& config, const std::vector<std::string>& assignments);

  Settings settings;
  OptionTable table;
};

/// A settings file with all options as they are now, with a heading that names the program's version.
std::string settings_file_text(const OptionTable& table);
std::string settings_file_text(const Settings& settings);

}  // namespace psi_slam
