// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <CLI/CLI.hpp>
#include <string>
#include <vector>

namespace psi_slam {

struct GuiCommandLine {
  std::string log;                    ///< empty: none is opened
  std::string edits;                  ///< empty: none
  std::string config;                 ///< empty: the built-in defaults
  std::vector<std::string> settings;  ///< "section.key=value", in the order given
};

/// Reads the arguments with `app`, which was made for this. Throws CLI::ParseError for --help, --version and
/// what CLI11 refuses, and UserError for arguments that mean nothing.
GuiCommandLine parse_gui_command_line(const std::vector<std::string>& arguments, CLI::App& app);

}  // namespace psi_slam
