// SPDX-License-Identifier: BSD-3-Clause
#include "graphslam_app.h"

#include <atomic>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <ostream>

#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "closing_text.h"
#include "graphslam_command_line.h"
#include "interrupt_signals.h"
#include "mrpt/graphslam_settings.h"
#include "psi_slam/user_error.h"
#include "run_program.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kName = "psi-graphslam";

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

/// Maps the log to its end. After a signal, only makes the map of what was read.
void make_map(GraphSlamRun& run, const std::atomic<bool>& stop, std::ostream& err) {
  while (!stop && run.step()) {
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
           "local_maps.smoothing_sigma_m to their noise and lower front_end.min_response\n";
  if (run.broken_off()) err << kName << ": " << broken_off_text(*run.broken_off(), run.scans()) << '\n';
}

void map_and_write(GraphSlamRun& run, const GraphSlamSetup& setup, const fs::path& output, bool force,
                   std::ostream& out, std::ostream& err) {
  const InterruptSignals signals;
  const OutputFolder folder = OutputFolder::prepare(output, force);
  make_map(run, signals.came(), err);
  run.write(folder);
  write_text_atomically(folder.path() / "summary.json",
                        summary_of(run, setup).dump(1, ' ', false, Json::error_handler_t::replace) + '\n');
  out << run.scans() << " scans, " << run.graph().nodes.size() << " nodes, " << run.graph().edges.size()
      << " edges; results in " << folder.path().string() << std::endl;
  print_warnings_of_log(run, err);
}

int map(const GraphSlamCommandLine& line, std::ostream& out, std::ostream& err) {
  const GraphSlamGeneral general = read_graphslam_general(line.setup.ini);
  BoundSettings bound;
  load_graphslam_settings(line.setup.ini, bound);
  for (const std::string& warning : bound.table.take_warnings()) err << kName << ": " << warning << '\n';
  const auto owned_run = make_graphslam_run(line.setup, DeciderCatalogue());
  GraphSlamRun& run = *owned_run;
  map_and_write(run, line.setup, line.output.empty() ? general.output_dir_fname : line.output, line.force,
                out, err);
  if (!run.interrupted()) run.wait_for_window();
  return run.broken_off() ? kExitWrongUsageOrInput : kExitDone;
}

int run(const GraphSlamCommandLine& line, std::ostream& out, std::ostream& err) {
  if (!line.lists() && !line.dump_options) return map(line, out, err);
  if (line.lists())
    list_deciders(line, out);
  else
    dump_options(out);
  return kExitDone;
}

}  // namespace

int run_graphslam_app(const std::vector<std::string>& arguments, std::ostream& out,
                      std::ostream& err) noexcept {
  CLI::App app("psi-graphslam runs MRPT's graph-slam engine with the deciders of MRPT and of psi-slam.",
               kName);
  return run_program(app, out, err,
                     [&] { return run(parse_graphslam_command_line(arguments, app), out, err); });
}

}  // namespace psi_slam
