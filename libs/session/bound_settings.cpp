// SPDX-License-Identifier: BSD-3-Clause
#include "session/bound_settings.h"

#include "config/apply_settings.h"
#include "config/ini_file.h"
#include "config/option_listing.h"
#include "psi_slam/version.h"

namespace psi_slam {

void BoundSettings::load(const std::filesystem::path& config, const std::vector<std::string>& assignments) {
  if (!config.empty()) apply(read_ini(config), table);
  for (const std::string& assignment : assignments) apply_override(assignment, table);
}

std::string settings_file_text(const OptionTable& table) {
  return "; Settings of psi-slam " PSI_SLAM_VERSION
         ". Lines that begin with a semicolon are comments.\n"
         "; Whatever a file does not set has its default.\n\n" +
         dump(table);
}

std::string settings_file_text(const Settings& settings) {
  BoundSettings bound;
  bound.settings = settings;
  return settings_file_text(bound.table);
}

}  // namespace psi_slam
