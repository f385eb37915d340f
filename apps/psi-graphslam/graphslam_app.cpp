// SPDX-License-Identifier: BSD-3-Clause
#include "graphslam_app.h"

#include <atomic>
#include <filesystem>
#include <new>
#include <nlohmann/json.hpp>
#include <ostream>

#include "closing_text.h"
#include "decider_listing.h"
#include "graphslam_command_line.h"
#include "interrupt_signals.h"
#include "base/atomic_file.h"
#include "base/exit_code.h"
#include "psi_slam/user_error.h"
#include "mrpt/graphslam_settings.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr const char* kName = "psi-graphslam";

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

/// All steps and the end of the log, until a signal comes: then only what the map needs.
void make_map(GraphSlamRun& run, const std::atomic<bool>& stop, std::ostream& err) {
  while (!stop && run.step()) {
  }
  bool told = false;
  const auto go_on = [&] {
    if (stop && !told) err << kName << ": " << interrupted_text(run.scans()) << std::endl;
    told = stop;
    return !stop;
  };
  go_on();
  run.finish([&](double /*share*/) { return go_on(); });
}

/// What the user should know of the log, on the error stream.
void tell_of_log(const GraphSlamRun& run, std::ostream& err) {
  if (2 * run.unmatched_scans() > run.scans())
    err << kName << ": " << run.unmatched_scans() << " of " << run.scans()
        << " scans could not be matched, odometry stands for them: where ranges are noisy, raise "
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
  tell_of_log(run, err);
}

int map(const GraphSlamCommandLine& line, std::ostream& out, std::ostream& err) {
  const GraphSlamGeneral general = read_graphslam_general(line.setup.ini);
  const auto owned_run = make_graphslam_run(line.setup, DeciderCatalogue());
  GraphSlamRun& run = *owned_run;
  map_and_write(run, line.setup, line.output.empty() ? general.output_dir_fname : line.output, line.force,
                out, err);
  if (!run.interrupted()) run.wait_for_window();
  return run.broken_off() ? kExitWrongUsageOrInput : kExitDone;
}

int run(const GraphSlamCommandLine& line, std::ostream& out, std::ostream& err) {
  int code = kExitDone;
  if (line.lists())
    list_deciders(line, out);
  else if (line.dump_options)
    dump_options(out);
  else
    code = map(line, out, err);
  out.flush();
  if (!out) throw SystemFailure("cannot write to standard output");
  return code;
}

}  // namespace

int run_graphslam_app(const std::vector<std::string>& arguments, std::ostream& out,
                      std::ostream& err) noexcept {
  CLI::App app("psi-graphslam runs MRPT's graph-slam engine with its deciders and psi-slam's.", kName);
  try {
    return run(parse_graphslam_command_line(arguments, app), out, err);
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked, out, err);
    return kExitDone;
  } catch (const CLI::ParseError& error) {
    err << kName << ": " << error.what() << " (see psi-graphslam --help)\n";
    return kExitWrongUsageOrInput;
  } catch (const UserError& error) {
    err << kName << ": " << error.what() << '\n';
    return kExitWrongUsageOrInput;
  } catch (const std::bad_alloc&) {
    err << kName << ": there is not enough memory\n";
    return kExitFailed;
  } catch (const std::exception& error) {
    err << kName << ": " << error.what() << '\n';
    return kExitFailed;
  }
}

}  // namespace psi_slam
