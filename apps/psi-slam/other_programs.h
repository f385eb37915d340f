// SPDX-License-Identifier: BSD-3-Clause
// The programs of the family that psi-slam starts as its commands: "psi-slam gui" runs psi-slam-gui.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

struct OtherProgram {
  const char* command;      ///< "gui"
  const char* program;      ///< "psi-slam-gui"
  const char* package;      ///< Debian package that contains the program
  const char* description;  ///< one line for the list of commands
};

/// The programs that are commands of psi-slam, in the order of the help text.
const std::vector<OtherProgram>& other_programs();

/// The program that a command runs; null if the command is none of other_programs().
const OtherProgram* other_program(std::string_view command);

/// Replaces this process by the program, which is looked for beside this one and then in PATH. Never returns.
/// Throws UserError if it is not installed, and SystemFailure if it cannot be started.
[[noreturn]] void become(const OtherProgram& other, const std::vector<std::string>& arguments);

}  // namespace psi_slam
