// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/settings_text.h"

#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/quotable_text.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Throws UserError if one file sets an option by both its old and its new name.
void require_one_name(const IniFile& file, const OptionTable& table) {
  std::map<std::pair<std::string, std::string>, const IniValue*> given;
  for (const IniValue& value : file.values) {
    const std::string path = value.where.substr(0, value.where.rfind(':'));
    const std::string name = table.current_name(value.section + '.' + value.key);
    const auto [first, is_new] = given.try_emplace({path, name}, &value);
    if (is_new) continue;
    throw UserError(value.where + ": " + value.section + '.' + value.key + " and " + first->second->section +
                    '.' + first->second->key + " (" + first->second->where +
                    ") are the same option; keep one, called " + name);
  }
}

/// The accepted values and the default in one line.
std::string values_and_default(const Option& option) {
  return option.values() + "; default " + ini_value_text(option.default_text);
}

/// Lines for the constants of a section that do not have their default values.
std::string changed_constants(const OptionTable& table, const std::string& section) {
  std::string lines;
  for (const auto& [name, constant] : table.constants())
    if (constant.section == section && constant.text() != constant.default_text)
      lines += "\n; A constant of the method. Only programs change it.\n" + constant.key + " = " +
               ini_value_text(constant.text()) + '\n';
  return lines;
}

/// Escapes a text for a cell of a Markdown table.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c;
  }
  return escaped;
}

}  // namespace

void apply(const IniFile& file, OptionTable& table) {
  for (const IniSection& section : file.sections) table.require_section(section.name, section.where);
  for (const IniValue& value : file.values)
    table.check(value.section + '.' + value.key, value.text, value.where);
  require_one_name(file, table);
  for (const IniValue& value : file.values)
    table.set(value.section + '.' + value.key, value.text, value.where);
}

void apply_override(std::string_view assignment, OptionTable& table, bool with_constants) {
  const std::size_t equals = assignment.find('=');
  const std::string_view name = trimmed(assignment.substr(0, equals));
  if (equals == std::string_view::npos || name.find('.') == std::string_view::npos)
    throw UserError("--set: expected section.key=value, not \"" + quotable(assignment) + '"');
  const std::string_view text = trimmed(assignment.substr(equals + 1));
  with_constants ? table.set_any(name, text, "--set") : table.set(name, text, "--set");
}

std::string commented(const Option& option, const std::string& name) {
  return "\n; " + option.help + "\n; " + values_and_default(option) + '\n' + name + " = " +
         ini_value_text(option.text()) + '\n';
}

std::string dump(const OptionTable& table) {
  std::string text;
  for (const OptionSection& section : table.sections()) {
    if (!text.empty()) text += '\n';
    text += "; " + section.title + "\n[" + section.name + "]\n";
    for (const Option& option : section.options) {
      const std::string value = option.text();
      if (!option.accepts(value))
        throw std::logic_error(option.name() + " holds " + value + ", which is not " + option.expectation());
      text += commented(option, option.key);
    }
    text += changed_constants(table, section.name);
  }
  // Sections of constants alone.
  std::set<std::string> others;
  for (const auto& [name, constant] : table.constants()) others.insert(constant.section);
  for (const OptionSection& section : table.sections()) others.erase(section.name);
  for (const std::string& section : others)
    if (const std::string lines = changed_constants(table, section); !lines.empty())
      text += "\n[" + section + "]\n" + lines;
  return text;
}

std::string help_text(const OptionTable& table, const std::function<bool(const Option&)>& selects) {
  std::string text;
  for (const OptionSection& section : table.sections()) {
    std::string options;
    for (const Option& option : section.options)
      if (selects(option))
        options +=
            "  " + option.name() + "\n      " + option.help + "\n      " + values_and_default(option) + '\n';
    if (options.empty()) continue;
    if (!text.empty()) text += '\n';
    text += '[' + section.name + "]  " + section.title + '\n' + options;
  }
  return text;
}

std::string markdown_reference(const OptionTable& table) {
  std::string text;
  for (const OptionSection& section : table.sections()) {
    if (!text.empty()) text += '\n';
    text += "## `[" + section.name + "]` " + section.title + "\n\n| key | values | default | meaning |\n" +
            "|---|---|---|---|\n";
    for (const Option& option : section.options) {
      text += "| `" + option.key + "` | " + cell(option.values()) + " | `" +
              cell(ini_value_text(option.default_text)) + "` | " + cell(option.help) + " |\n";
    }
  }
  return text;
}

}  // namespace psi_slam
