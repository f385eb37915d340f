// SPDX-License-Identifier: BSD-3-Clause
#include "command_words.h"

#include <algorithm>

namespace psi_slam {

WordKind kind_of_value(const CLI::Option& option) {
  if (option.nonpositional() && option.get_items_expected_max() == 0) return WordKind::kNothing;
  if (!option.nonpositional() && option.get_name(true) == "COMMAND") return WordKind::kCommand;
  const std::string name = value_name(option);
  if (name == "DIR") return WordKind::kFolder;
  if (name.rfind("SECTION.KEY=VALUE", 0) == 0) return WordKind::kSetting;
  const bool is_file = !option.nonpositional() || name == "FILE" || name == "INI" || name == "LOG";
  return is_file ? WordKind::kFile : WordKind::kOther;
}

std::string value_name(const CLI::Option& option) {
  if (option.nonpositional() && option.get_items_expected_max() == 0) return "";
  std::string name = option.get_type_name();
  name.erase(std::min(name.find(':'), name.size()));
  if (name == "INT" || name == "UINT") return "N";
  return name == "FLOAT" ? "NUMBER" : name;
}

std::string option_text(const CLI::Option& option) {
  std::string text = option.get_description();
  std::string value = option.get_default_str();
  // CLI11 writes a list of values in brackets, which the user does not type.
  if (!value.empty() && value.front() == '[' && value.back() == ']')
    value = value.substr(1, value.size() - 2);
  if (!value.empty()) text += " (default " + value + ')';
  if (option.nonpositional() && option.get_required()) text += " (required)";
  return text;
}

bool takes_many(const CLI::Option& positional) {
  return positional.get_items_expected_max() > 1;
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
