// SPDX-License-Identifier: BSD-3-Clause
#include "gui_command_line.h"

#include "command_line.h"
#include "document_options.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

GuiCommandLine parse_gui_command_line(const std::vector<std::string>& arguments, CLI::App& app) {
  GuiCommandLine line;
  app.add_option("LOG", line.log,
                 "Log to open: an MRPT rawlog or a CARMEN log, plain or gzipped, a ROS bag, or a session")
      ->type_name("");
  app.add_option("--edits", line.edits,
                 "Loops deleted, forced or matched by hand: a file as File > Save loop edits makes it")
      ->type_name("FILE");
  add_settings_options(app, line.config, line.settings);
  app.set_version_flag("--version", "psi-slam-gui " PSI_SLAM_VERSION, "Print the version, and exit");
  add_document_options(app, default_settings());
  app.allow_extras();
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
  if (const std::vector<std::string> unknown = app.remaining(); !unknown.empty())
    throw UserError(unknown_argument_text(unknown.front(), app, "psi-slam-gui"));
  if (!line.edits.empty() && line.log.empty()) throw UserError("--edits goes with a log: name it, too");
  return line;
}

}  // namespace psi_slam
