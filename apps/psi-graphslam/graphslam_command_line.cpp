// SPDX-License-Identifier: BSD-3-Clause
#include "graphslam_command_line.h"

#include <cstdlib>

#include "document_options.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"

namespace psi_slam {
namespace {

constexpr const char* kExamples =
    "\nExamples:\n"
    "  psi-graphslam -i graphslam.ini -r my.rawlog            use psi-slam's deciders and optimizer\n"
    "  psi-graphslam -i graphslam.ini -r my.rawlog -n CFixedIntervalsNRD -e CLoopCloserERD -o CPsiSpaGSO\n"
    "  psi-graphslam --list-deciders                          list all deciders and optimizers\n";

struct Switches {
  bool plane = false;
  bool space = false;
  bool disable_visuals = false;
  bool list_regs = false;
  bool list_all = false;
  std::string ini;
  std::string log;
  std::string ground_truth;
};

bool has_display() {
  const char* const display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

void add_inputs(CLI::App& app, Switches& switches, GraphSlamSetup& setup) {
  app.add_option("-i,--ini-file,--ini", switches.ini, "Settings file, as for MRPT's graphslam-engine")
      ->type_name("INI");
  app.add_option("-r,--rawlog", switches.log,
                 "Log: an MRPT rawlog or a CARMEN log, plain or gzipped, or a ROS bag")
      ->type_name("LOG");
  app.add_option("-g,--ground-truth", switches.ground_truth, "True poses, in the format of GridMapNavSimul")
      ->type_name("FILE");
  app.add_option("-n,--node-reg", setup.node_decider, "Node registration decider")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("-e,--edge-reg", setup.edge_decider, "Edge registration decider")
      ->type_name("NAME")
      ->capture_default_str();
  app.add_option("-o,--optimizer", setup.optimizer, "Optimizer of the graph")
      ->type_name("NAME")
      ->capture_default_str();
}

void add_switches(CLI::App& app, Switches& switches, GraphSlamCommandLine& line) {
  app.add_option("--output-dir", line.output,
                 "Folder for the results. Default: output_dir_fname of the settings")
      ->type_name("DIR");
  app.add_flag("--force", line.force, "Replace results in a folder that is not empty");
  app.add_flag("--disable-visuals", switches.disable_visuals, "Do not open MRPT's window");
  app.add_flag("--2d", switches.plane, "Make a 2-D map (the default)");
  app.add_flag("--3d", switches.space, "Not supported: use MRPT's graphslam-engine");
  app.add_flag("--list-node-regs", line.list_node_deciders, "List the node registration deciders and exit");
  app.add_flag("--list-edge-regs", line.list_edge_deciders, "List the edge registration deciders and exit");
  app.add_flag("--list-regs", switches.list_regs, "List node and edge registration deciders and exit");
  app.add_flag("--list-optimizers", line.list_optimizers, "List the optimizers and exit");
  app.add_flag("--list-deciders", switches.list_all, "List all deciders and optimizers and exit");
  app.add_flag("--dump-options", line.dump_options,
               "Print all options of psi-slam's deciders and optimizer as a settings file and exit");
  app.set_version_flag("--version", "psi-graphslam " PSI_SLAM_VERSION, "Print the version and exit");
  app.footer(kExamples);
  add_document_options(app);
}

void check_inputs(const Switches& switches) {
  const std::string see_help = " (see psi-graphslam --help)";
  if (switches.space) throw UserError("--3d: psi-graphslam makes only 2-D maps. Use MRPT's graphslam-engine");
  if (switches.ini.empty()) throw UserError("name the settings file: -i INI" + see_help);
  if (switches.log.empty()) throw UserError("name the log: -r LOG" + see_help);
}

}  // namespace

GraphSlamCommandLine parse_graphslam_command_line(const std::vector<std::string>& arguments, CLI::App& app) {
  GraphSlamCommandLine line;
  Switches switches;
  add_inputs(app, switches, line.setup);
  add_switches(app, switches, line);
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
  line.list_node_deciders |= switches.list_regs || switches.list_all;
  line.list_edge_deciders |= switches.list_regs || switches.list_all;
  line.list_optimizers |= switches.list_all;
  if (line.lists() || line.dump_options) return line;
  check_inputs(switches);
  line.setup.ini = switches.ini;
  line.setup.log = switches.log;
  line.setup.ground_truth = switches.ground_truth;
  line.setup.visuals = !switches.disable_visuals && has_display();
  return line;
}

}  // namespace psi_slam
