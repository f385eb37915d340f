// SPDX-License-Identifier: BSD-3-Clause
#include "command_words.h"

namespace psi_slam {

WordKind kind_of_value(const CLI::Option& option) {
  if (option.nonpositional() && option.get_items_expected_max() == 0) return WordKind::kNothing;
  const std::string name = value_name(option);
  if (name == "DIR") return WordKind::kFolder;
  if (name.rfind("SECTION.KEY=VALUE", 0) == 0) return WordKind::kSetting;
  const bool is_file = !option.nonpositional() || name == "FILE" || name == "INI" || name == "LOG";
  return is_file ? WordKind::kFile : WordKind::kOther;
}

std::string value_name(const CLI::Option& option) {
  if (option.nonpositional() && option.get_items_expected_max() == 0) return "";
  const std::string name = option.get_type_name();
  return name.substr(0, name.find(':'));
}

std::vector<const CLI::Option*> shown_options(const CLI::App& app) {
  return app.get_options(
      [](const CLI::Option* option) { return option->nonpositional() && !option->get_group().empty(); });
}

std::vector<const CLI::Option*> shown_positionals(const CLI::App& app) {
  return app.get_options([](const CLI::Option* option) { return !option->nonpositional(); });
}

std::vector<const CLI::App*> shown_commands(const CLI::App& app) {
  return app.get_subcommands([](const CLI::App* command) { return !command->get_group().empty(); });
}

std::vector<std::string> typed_names(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

}  // namespace psi_slam
