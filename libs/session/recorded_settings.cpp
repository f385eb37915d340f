// SPDX-License-Identifier: BSD-3-Clause
#include "session/recorded_settings.h"

#include <algorithm>

#include "base/config/ini_file.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

/// Whether an option changes neither poses nor loops, only files and speed.
bool is_free(const Option& option) {
  return option.section == "map" || option.section == "localization" || option.section == "live" ||
         option.name() == "run.threads";
}

struct ChangedSetting {
  std::string name;
  std::string before;
  std::string now;
};

/// The settings of `kept` that have another value in `table`, sorted by name.
std::vector<ChangedSetting> changed_settings(const std::map<std::string, std::string>& kept,
                                             const OptionTable& table) {
  std::vector<ChangedSetting> changed;
  for (const auto& [name, text] : kept_settings(table))
    if (const std::string& before = kept.at(name); text != before) changed.push_back({name, before, text});
  return changed;
}

}  // namespace

std::vector<std::string> load_recorded(BoundSettings& bound, const SessionFacts& facts,
                                       const std::filesystem::path& file) {
  std::string obsolete;
  for (const IniValue& value : parse_ini(facts.settings, file).values) {
    const std::string name = value.section + '.' + value.key;
    if (bound.table.knows(name) || bound.table.is_constant(name))
      bound.table.set_any(name, value.text, value.where);
    else
      obsolete += (obsolete.empty() ? "" : ", ") + name;
  }
  bound.table.take_warnings();  // drops warnings about old names, which users cannot edit in a session
  if (obsolete.empty()) return {};
  return {file.string() + ": ignores obsolete options: " + obsolete};
}

std::optional<std::string> other_version_text(const std::filesystem::path& file, const SessionFacts& facts) {
  if (facts.program_version == PSI_SLAM_VERSION) return std::nullopt;
  return file.string() + " was made by psi-slam " + facts.program_version +
         ". This is psi-slam " PSI_SLAM_VERSION ", which may give a different map";
}

std::map<std::string, std::string> kept_settings(const OptionTable& table) {
  std::map<std::string, std::string> kept;
  for (const Option* option : table.options_and_constants())
    if (!is_free(*option)) kept[option->name()] = option->text();
  return kept;
}

std::optional<std::string> changed_settings_text(const std::filesystem::path& file, const SessionFacts& facts,
                                                 const OptionTable& table) {
  constexpr std::size_t kNamed = 3;
  BoundSettings recorded;
  load_recorded(recorded, facts, file);
  const std::vector<ChangedSetting> changed = changed_settings(kept_settings(recorded.table), table);
  if (changed.empty()) return std::nullopt;
  std::string text =
      file.string() + " was mapped with other settings and is mapped again with the current settings: ";
  for (std::size_t i = 0; i < std::min(changed.size(), kNamed); ++i) {
    const auto value_text = [](const std::string& value) { return value.empty() ? "empty" : value; };
    text += (i == 0 ? "" : ", ") + changed[i].name + " was " + value_text(changed[i].before) + " and is " +
            value_text(changed[i].now);
  }
  if (changed.size() > kNamed) text += ", and " + std::to_string(changed.size() - kNamed) + " more";
  return text;
}

void require_kept(const std::map<std::string, std::string>& kept, const OptionTable& table,
                  const std::filesystem::path& file) {
  const std::vector<ChangedSetting> changed = changed_settings(kept, table);
  if (changed.empty()) return;
  const auto& [name, before, now] = changed.front();
  throw UserError(
      name + " is " + before + " in the session " + file.string() + " and cannot become " + now +
      ": a resumed session keeps all settings except [map], [localization], [live] and run.threads. "
      "Remove this setting");
}

}  // namespace psi_slam
