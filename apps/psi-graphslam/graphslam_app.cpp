// SPDX-License-Identifier: BSD-3-Clause
#include "graphslam_app.h"

#include <new>
#include <nlohmann/json.hpp>
#include <ostream>

#include "decider_listing.h"
#include "graphslam_command_line.h"
#include "psi_slam/base/atomic_file.h"
#include "psi_slam/base/user_error.h"
#include "psi_slam/graphslam/graphslam_settings.h"

namespace psi_slam {
namespace {

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsageOrInput = 2;

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

nlohmann::ordered_json summary_of(const GraphSlamRun& run, const GraphSlamSetup& setup) {
  nlohmann::ordered_json edges = nlohmann::ordered_json::object();
  for (const auto& [kind, count] : run.edge_counts()) edges[kind] = count;
  return {{"schema", "psi-graphslam-run"},      {"schema_version", 1},
          {"node_decider", setup.node_decider}, {"edge_decider", setup.edge_decider},
          {"optimizer", setup.optimizer},       {"scans", run.scans()},
          {"nodes", run.graph().nodes.size()},  {"edges", run.graph().edges.size()},
          {"edge_decider_counts", edges}};
}

void map(const GraphSlamCommandLine& line, std::ostream& out) {
  const GraphSlamGeneral general = read_graphslam_general(line.setup.ini);
  GraphSlamRun run(line.setup, DeciderCatalogue());
  const OutputFolder folder =
      OutputFolder::prepare(line.output.empty() ? general.output_dir_fname : line.output, line.force);
  while (run.step()) {
  }
  run.finish();
  run.write(folder);
  const nlohmann::ordered_json summary = summary_of(run, line.setup);
  write_text_atomically(folder.path() / "summary.json", summary.dump(1) + '\n');
  out << run.scans() << " scans, " << run.graph().nodes.size() << " nodes, " << run.graph().edges.size()
      << " edges; results in " << folder.path().string() << '\n';
  run.wait_for_window();
}

void run(const GraphSlamCommandLine& line, std::ostream& out) {
  if (line.lists())
    list_deciders(line, out);
  else if (line.dump_options)
    dump_options(out);
  else
    map(line, out);
  out.flush();
  if (!out) throw SystemFailure("cannot write to standard output");
}

}  // namespace

int run_graphslam_app(const std::vector<std::string>& arguments, std::ostream& out,
                      std::ostream& err) noexcept {
  CLI::App app("psi-graphslam runs MRPT's graph-slam engine with its deciders and psi-slam's.",
               "psi-graphslam");
  try {
    run(parse_graphslam_command_line(arguments, app), out);
    return kDone;
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked, out, err);
    return kDone;
  } catch (const CLI::ParseError& error) {
    err << "psi-graphslam: " << error.what() << " (see psi-graphslam --help)\n";
    return kWrongUsageOrInput;
  } catch (const UserError& error) {
    err << "psi-graphslam: " << error.what() << '\n';
    return kWrongUsageOrInput;
  } catch (const std::bad_alloc&) {
    err << "psi-graphslam: there is not enough memory\n";
    return kFailed;
  } catch (const std::exception& error) {
    err << "psi-graphslam: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace psi_slam
