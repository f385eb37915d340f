// SPDX-License-Identifier: BSD-3-Clause
// Documents that are installed beside a program: manual pages and shell completion. They are made from the
// definition of its command line and from the table of its settings.
#pragma once

#include <CLI/CLI.hpp>
#include <array>
#include <map>
#include <memory>
#include <string>

#include "base/config/option_table.h"

namespace psi_slam {

/// Adds an option or argument that sets `member`. `type` names the value in help texts, such as "FILE".
template <class Member>
CLI::Option* add_value(CLI::App& app, const std::string& names, Member& member, const std::string& help,
                       const std::string& type) {
  return app.add_option(names, member, help)->type_name(type);
}

/// What the documents of a program need beside the definition of its command line.
struct ProgramFacts {
  std::array<std::string, 3> exit_codes;  ///< sentences that say when the program ends with 0, 1 and 2
  std::shared_ptr<const OptionTable> settings{};  ///< options that --set changes; null: none
  std::string optional_command{};  ///< command that may be left out: it has the options of the program itself
  /// Programs that commands start, by the name of the command: "gui" starts "psi-slam-gui".
  std::map<std::string, std::string> programs{};
};

/// Adds the hidden options --man-page, --bash-completion and, if there are settings, --settings-man-page.
/// Each prints its document and ends the program, as --version does. Lets --help show options as the man page
/// does. Call it after all commands are added. `app` must outlive the parsing.
void add_document_options(CLI::App& app, const ProgramFacts& facts);

/// Manual page of a program. The description of `app` may begin with the program's name and must go on with a
/// verb, as in "psi-slam draws floor plans". The first clause of the description becomes the section NAME.
std::string man_page(const CLI::App& app, const ProgramFacts& facts);

/// Manual page psi-slam.ini(5) of the settings files. `version` names program and version, as --version does.
std::string settings_man_page(const OptionTable& table, const std::string& version);

/// Completion script for bash, and for zsh through its bashcompinit. Completes commands, options, files,
/// folders, and the keys and values of settings after --set. After a command that starts another program,
/// loads the script of that program from the same folder. The script needs bash 4.
std::string bash_completion(const CLI::App& app, const ProgramFacts& facts);

}  // namespace psi_slam
