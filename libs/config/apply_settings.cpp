// SPDX-License-Identifier: BSD-3-Clause
#include "config/apply_settings.h"

#include <map>
#include <utility>

#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

namespace {

/// Throws UserError if one file gives an option by its old and by its new name.
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

}  // namespace

void apply(const IniFile& file, OptionTable& table) {
  for (const IniSection& section : file.sections) table.require_section(section.name, section.where);
  for (const IniValue& value : file.values)
    table.check(value.section + '.' + value.key, value.text, value.where);
  require_one_name(file, table);
  for (const IniValue& value : file.values)
    table.set(value.section + '.' + value.key, value.text, value.where);
}

void apply_override(std::string_view assignment, OptionTable& table) {
  const std::size_t equals = assignment.find('=');
  const std::string_view name = trimmed(assignment.substr(0, equals));
  if (equals == std::string_view::npos || name.find('.') == std::string_view::npos)
    throw UserError("--set: expected section.key=value, not \"" + std::string(assignment) + '"');
  table.set(name, trimmed(assignment.substr(equals + 1)), "--set");
}

}  // namespace psi_slam
