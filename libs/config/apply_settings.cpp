// SPDX-License-Identifier: BSD-3-Clause
#include "config/apply_settings.h"

#include <utility>
#include <vector>

#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

void apply(const IniFile& file, OptionTable& table) {
  for (const IniSection& section : file.sections) table.require_section(section.name, section.where);
  std::vector<std::pair<const Option*, std::string>> overwritten;
  try {
    for (const IniValue& value : file.values) {
      const Option& option = table.option(value.section + '.' + value.key, value.where);
      overwritten.emplace_back(&option, option.text());
      table.set(option.name(), value.text, value.where);
    }
  } catch (...) {
    for (auto change = overwritten.rbegin(); change != overwritten.rend(); ++change)
      change->first->assign(change->second);
    throw;
  }
}

void apply_override(std::string_view assignment, OptionTable& table) {
  const std::size_t equals = assignment.find('=');
  const std::string_view name = trimmed(assignment.substr(0, equals));
  if (equals == std::string_view::npos || name.find('.') == std::string_view::npos)
    throw UserError("--set: expected section.key=value, not \"" + std::string(assignment) + '"');
  table.set(name, trimmed(assignment.substr(equals + 1)), "--set");
}

}  // namespace psi_slam
