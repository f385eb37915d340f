// SPDX-License-Identifier: BSD-3-Clause
#include "config/option_listing.h"

#include <stdexcept>

#include "config/ini_file.h"

namespace psi_slam {
namespace {

std::string default_words(const Option& option) {
  return "default " + ini_value_text(option.default_text);
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

std::string dump(const OptionTable& table) {
  std::string text;
  for (const OptionSection& section : table.sections()) {
    if (!text.empty()) text += '\n';
    text += "; " + section.title + "\n[" + section.name + "]\n";
    for (const Option& option : section.options) {
      const std::string value = option.text();
      if (!option.accepts(value))
        throw std::logic_error(option.name() + " holds " + value + ", which is not " + option.expectation());
      text += "\n; " + option.help + "\n; " + option.values() + "; " + default_words(option) + '\n' +
              option.key + " = " + ini_value_text(value) + '\n';
    }
  }
  return text;
}

std::string help_text(const OptionTable& table) {
  std::string text;
  for (const OptionSection& section : table.sections()) {
    if (!text.empty()) text += '\n';
    text += '[' + section.name + "]  " + section.title + '\n';
    for (const Option& option : section.options) {
      text += "  " + option.name() + "\n      " + option.help + "\n      " + option.values() + "; " +
              default_words(option) + '\n';
    }
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
