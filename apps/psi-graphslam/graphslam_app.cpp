// SPDX-License-Identifier: BSD-3-Clause
#include "graphslam_app.h"

#include <atomic>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "batch/kept_run.h"
#include "closing_text.h"
#include "document_options.h"
#include "interrupt_signals.h"
#include "mrpt/graphslam_run.h"
#include "mrpt/graphslam_settings.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"
#include "run_program.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kName = "psi-graphslam";
constexpr const char* kExamples =
    "\nExamples:\n"
    "  psi-graphslam -i graphslam.ini -r my.rawlog            use psi-slam's deciders and optimizer\n"
    "  psi-graphslam -i graphslam.ini -r my.rawlog -n CFixedIntervalsNRD -e CLoopCloserERD -o CPsiSpaGSO\n"
    "  psi-graphslam --list-deciders                          list all deciders and optimizers\n";

struct GraphSlamCommandLine {
  GraphSlamSetup setup;
  std::string output;  ///< folder for the results; empty: output_dir_fname of the settings file
  bool force = false;
  bool plane = false;
  bool space = false;
  bool disable_visuals = false;
  bool list_node_deciders = false;
  bool list_edge_deciders = false;
  bool list_optimizers = false;
  bool list_regs = false;  ///< list node and edge deciders
  bool list_all = false;
  bool dump_options = false;

  bool lists() const { return list_node_deciders || list_edge_deciders || list_optimizers; }
};

bool has_display() {
  const char* const display = std::getenv("DISPLAY");
  return display != nullptr && *display != '\0';
}

void add_inputs(CLI::App& app, GraphSlamSetup& setup) {
  add_value(app, "-i,--ini-file,--ini", setup.ini, "Settings file, as for MRPT's graphslam-engine", "INI");
  add_value(app, "-r,--rawlog", setup.log,
            "Log: an MRPT rawlog or a CARMEN log, plain or compressed, or a ROS bag", "LOG");
  add_value(app, "-g,--ground-truth", setup.ground_truth, "True poses, in the format of GridMapNavSimul",
            "FILE");
  const auto add_name = [&](const char* names, std::string& name, const char* help) {
    add_value(app, names, name, help, "NAME")->capture_default_str();
  };
  add_name("-n,--node-reg", setup.node_decider, "Node registration decider");
  add_name("-e,--edge-reg", setup.edge_decider, "Edge registration decider");
  add_name("-o,--optimizer", setup.optimizer, "Optimizer of the graph");
}

void add_switches(CLI::App& app, GraphSlamCommandLine& line) {
  add_value(app, "--output-dir", line.output,
            "Folder for the results. Default: output_dir_fname of the settings", "DIR");
  app.add_flag("--force", line.force, "Replace results in a folder that is not empty");
  app.add_flag("--disable-visuals", line.disable_visuals, "Do not open MRPT's window");
  app.add_flag("--2d", line.plane, "Make a 2-D map (the default)");
  app.add_flag("--3d", line.space, "Not supported: use MRPT's graphslam-engine");
  app.add_flag("--list-node-regs", line.list_node_deciders, "List the node registration deciders and exit");
  app.add_flag("--list-edge-regs", line.list_edge_deciders, "List the edge registration deciders and exit");
  app.add_flag("--list-regs", line.list_regs, "List node and edge registration deciders and exit");
  app.add_flag("--list-optimizers", line.list_optimizers, "List the optimizers and exit");
  app.add_flag("--list-deciders", line.list_all, "List all deciders and optimizers and exit");
  app.add_flag("--dump-options", line.dump_options,
               "Print all options of psi-slam's deciders and optimizer as a settings file and exit");
  app.set_version_flag("--version", "psi-graphslam " PSI_SLAM_VERSION, "Print the version and exit");
  app.footer(kExamples);
  add_document_options(
      app, {{"Success. Ctrl-C ends the run with this code, too, and the results show the scans read so far.",
             "Something failed, such as a full disk.",
             "The arguments, the settings or the log are invalid. A log that breaks off is mapped up to the "
             "break."}});
}

void check_inputs(const GraphSlamCommandLine& line) {
  const std::string see_help = " (see psi-graphslam --help)";
  if (line.space) throw UserError("--3d: psi-graphslam makes only 2-D maps. Use MRPT's graphslam-engine");
  if (line.setup.ini.empty()) throw UserError("name the settings file: -i INI" + see_help);
  if (line.setup.log.empty()) throw UserError("name the log: -r LOG" + see_help);
}

/// Parses the arguments, without the program's name. Throws CLI::ParseError for wrong usage, --help and
/// --version, and UserError for missing arguments and for --3d.
GraphSlamCommandLine parse(const std::vector<std::string>& arguments, CLI::App& app) {
  GraphSlamCommandLine line;
  add_inputs(app, line.setup);
  add_switches(app, line);
  // CLI11 expects the last argument first.
  app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));
  line.list_node_deciders |= line.list_regs || line.list_all;
  line.list_edge_deciders |= line.list_regs || line.list_all;
  line.list_optimizers |= line.list_all;
  if (line.lists() || line.dump_options) return line;
  check_inputs(line);
  line.setup.visuals = !line.disable_visuals && has_display();
  return line;
}

std::string decider_listing(const std::string& heading, const std::vector<DeciderDescription>& deciders) {
  std::string text = heading + "\n";
  for (const DeciderDescription& decider : deciders) {
    text += "  " + decider.name + (decider.is_ours ? " (psi-slam)" : " (MRPT)") + '\n';
    text += "      " + decider.description + '\n';
    if (!decider.rawlog_format.empty()) text += "      rawlog format: " + decider.rawlog_format + '\n';
    for (const std::string& observation : decider.observations) text += "      uses " + observation + '\n';
  }
  return text;
}

void list_deciders(const GraphSlamCommandLine& line, std::ostream& out) {
  const DeciderCatalogue catalogue;
  if (line.list_node_deciders)
    out << decider_listing("Node registration deciders:", catalogue.node_deciders());
  if (line.list_edge_deciders)
    out << decider_listing("Edge registration deciders:", catalogue.edge_deciders());
  if (line.list_optimizers) out << decider_listing("Optimizers:", catalogue.optimizers());
}

void dump_options(std::ostream& out) {
  const BoundSettings bound;
  for (const char* section : {kNodeDeciderSection, kEdgeDeciderSection, kOptimizerSection})
    out << '[' << section << "]\n" << graphslam_options_text(bound.table, section) << '\n';
}

Json summary_of(const GraphSlamRun& run, const GraphSlamSetup& setup) {
  Json edges = Json::object();
  for (const auto& [kind, count] : run.edge_counts()) edges[kind] = count;
  return {{"schema", "psi-graphslam-run"},
          {"schema_version", 1},
          {"node_decider", setup.node_decider},
          {"edge_decider", setup.edge_decider},
          {"optimizer", setup.optimizer},
          {"scans", run.scans()},
          {"nodes", run.graph().nodes.size()},
          {"edges", run.graph().edges.size()},
          {"edge_decider_counts", edges},
          {"unmatched_scans", run.unmatched_scans()},
          {"interrupted", run.interrupted()},
          {"broken_off", run.broken_off() ? Json(*run.broken_off()) : Json()}};
}

/// Maps the log to its end. After a signal, reads no more scans and finishes the map of the scans read so
/// far, at least one.
void make_map(GraphSlamRun& run, const std::atomic<bool>& stop, std::ostream& err) {
  while (run.step() && !stop) {
  }
  bool reported = false;
  const auto goes_on = [&] {
    if (stop && !reported) err << kName << ": " << interrupted_text(run.scans()) << std::endl;
    reported = stop;
    return !stop;
  };
  goes_on();
  run.finish([&](double /*share*/) { return goes_on(); });
}

void print_warnings_of_log(const GraphSlamRun& run, std::ostream& err) {
  if (2 * run.unmatched_scans() > run.scans())
    err << kName << ": " << run.unmatched_scans() << " of " << run.scans()
        << " scans could not be matched and are placed by odometry. If the ranges are noisy, raise "
           "local_maps.smoothing_sigma_m to their noise\n";
  if (run.broken_off()) err << kName << ": " << broken_off_text(*run.broken_off(), run.scans()) << '\n';
}

void map_and_write(GraphSlamRun& run, const GraphSlamSetup& setup, const fs::path& output, bool force,
                   std::ostream& out, std::ostream& err) {
  const InterruptSignals signals;
  const OutputFolder folder = OutputFolder::prepare(output, force);
  make_map(run, signals.came(), err);
  run.write(folder);
  write_text_atomically(folder.path() / "summary.json", json_file_text(summary_of(run, setup)));
  out << run.scans() << " scans, " << run.graph().nodes.size() << " nodes, " << run.graph().edges.size()
      << " edges; results in " << folder.path().string() << std::endl;
  print_warnings_of_log(run, err);
}

int map(const GraphSlamCommandLine& line, std::ostream& out, std::ostream& err) {
  const GraphSlamGeneral general = read_graphslam_general(line.setup.ini);
  BoundSettings bound;
  load_graphslam_settings(line.setup.ini, bound);
  for (const std::string& warning : bound.table.take_warnings()) err << kName << ": " << warning << '\n';
  const auto run = make_graphslam_run(line.setup, DeciderCatalogue());
  map_and_write(*run, line.setup, line.output.empty() ? general.output_dir_fname : line.output, line.force,
                out, err);
  if (!run->interrupted()) run->wait_for_window();
  return run->broken_off() ? kExitWrongUsageOrInput : kExitDone;
}

int run(const GraphSlamCommandLine& line, std::ostream& out, std::ostream& err) {
  if (line.lists())
    list_deciders(line, out);
  else if (line.dump_options)
    dump_options(out);
  else
    return map(line, out, err);
  return kExitDone;
}

}  // namespace

int run_graphslam_app(const std::vector<std::string>& arguments, std::ostream& out,
                      std::ostream& err) noexcept {
  CLI::App app("psi-graphslam runs MRPT's graph-slam engine with the deciders of MRPT and of psi-slam.",
               kName);
  return run_program(app, out, err, [&] { return run(parse(arguments, app), out, err); });
}

}  // namespace psi_slam
