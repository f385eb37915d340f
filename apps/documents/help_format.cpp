// SPDX-License-Identifier: BSD-3-Clause
#include "help_format.h"

#include <memory>

#include "command_words.h"

namespace psi_slam {
namespace {

class HelpFormat : public CLI::Formatter {
 public:
  std::string make_option_opts(const CLI::Option* option) const override {
    if (!option->nonpositional()) return takes_many(*option) ? " ..." : "";
    const std::string value = value_name(*option);
    return value.empty() ? "" : ' ' + value;
  }

  std::string make_option_desc(const CLI::Option* option) const override { return option_text(*option); }
};

}  // namespace

void format_help(CLI::App& app) {
  const auto format = std::make_shared<HelpFormat>();
  app.formatter(format);
  for (CLI::App* command : app.get_subcommands({})) command->formatter(format);
}

}  // namespace psi_slam
