// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_benchmark.h"

#include <cmath>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/log_plots.h"
#include "false_loops/bent_path.h"

namespace psi_slam {
namespace {

/// Trials with one kind and one share of false loops on one log, one trial for each seed.
using Trials = std::vector<FalseLoopRow>;

std::vector<Trials> cases_of(const FalseLoopBenchmark& benchmark) {
  return by_case(benchmark.rows, [](const FalseLoopRow& a, const FalseLoopRow& b) {
    return a.log == b.log && a.kind == b.kind && a.share_percent == b.share_percent;
  });
}

/// Member of a trial with the outcome of one treatment of the false loops.
using Treatment = LoopTrialOutcome FalseLoopRow::*;

using Column = ColumnOf<Trials>;

/// Statistics of value_of(outcome) over the trials.
template <class ValueOf>
SeedSpread spread_of_trials(const Trials& trials, Treatment treatment, const ValueOf& value_of) {
  return spread_over(trials, [&](const FalseLoopRow& trial) { return value_of(trial.*treatment); });
}

double translation_error_m(const LoopTrialOutcome& outcome) {
  return outcome.error.translation_m;
}

/// Columns of a treatment, which is named `key` in JSON. Markdown leaves out columns with an empty head.
struct TreatmentColumns {
  Treatment treatment;
  std::string key;
  std::string translation_head;
  int translation_decimals;
  std::string rotation_head{};
  std::string counts_head{};
  std::string time_head{};
};

void add_columns(const TreatmentColumns& of, std::vector<Column>& columns) {
  const auto add = [&](const std::string& head, const std::string& key, int decimals, const auto& value_of) {
    columns.push_back({{head, of.key + '.' + key}, [=, treatment = of.treatment](const Trials& trials) {
                         return cell(spread_of_trials(trials, treatment, value_of), decimals);
                       }});
  };
  const auto false_kept = [](const LoopTrialOutcome& outcome) { return outcome.false_kept; };
  const auto true_lost = [](const LoopTrialOutcome& outcome) { return outcome.true_lost; };
  const auto time_ms = [](const LoopTrialOutcome& outcome) { return outcome.milliseconds; };
  add(of.translation_head, "translation_error_m", of.translation_decimals, translation_error_m);
  add(of.rotation_head, "rotation_error_deg", 3,
      [](const LoopTrialOutcome& outcome) { return outcome.error.rotation_deg; });
  columns.push_back({{of.counts_head}, [=, treatment = of.treatment](const Trials& trials) {
                       const int decimals = trials.size() > 1 ? 1 : 0;
                       return cell(
                           fixed_text(spread_of_trials(trials, treatment, false_kept).mean, decimals) +
                           " / " + fixed_text(spread_of_trials(trials, treatment, true_lost).mean, decimals));
                     }});
  add({}, "false_kept", 1, false_kept);
  add({}, "true_lost", 1, true_lost);
  add({}, "time_ms", 0, time_ms);
  columns.push_back({{of.time_head}, [=, treatment = of.treatment](const Trials& trials) {
                       return cell(spread_of_trials(trials, treatment, time_ms).mean, 0);
                     }});
}

ReportTable cases_table(const FalseLoopBenchmark& benchmark) {
  std::vector<Column> columns{
      {{"log", "log", true}, [](const Trials& trials) { return cell(trials.front().log); }},
      {{"kind", "kind", true}, [](const Trials& trials) { return cell(name_of(trials.front().kind)); }},
      {{"share %", "share_percent"},
       [](const Trials& trials) { return cell(trials.front().share_percent, 0); }},
      {{{}, "seeds"},
       [](const Trials& trials) {
         return ReportCell{{}, seeds_of(trials)};
       }},
      {{{}, "true_loops"}, [](const Trials& trials) { return cell(trials.front().true_loops); }},
      {{"false loops or slips", "false_loops"},
       [](const Trials& trials) { return cell(trials.front().false_loops); }}};
  add_columns({&FalseLoopRow::undefended, "undefended", "undefended [m]", 3}, columns);
  add_columns({&FalseLoopRow::defended, "defended", "defended [m]", 4, "[deg]", "kept / lost", "ms"},
              columns);
  add_columns({&FalseLoopRow::from_map, "from_map", "from the map [m]", 4, {}, "kept / lost"}, columns);
  return table_of(columns, cases_of(benchmark));
}

ReportTable graphs_table(const std::vector<FalseLoopLog>& logs) {
  using Log = FalseLoopLog;
  using Error = LoopTrial::Error;
  const auto error = [](const std::string& head, const std::string& key, Error Log::*map,
                        double Error::*value, int decimals) {
    return ColumnOf<Log>{{head, key}, [=](const Log& log) { return cell(log.*map.*value, decimals); }};
  };
  return table_of<Log>(
      {column("log", "name", &Log::name), column("nodes", "nodes", &Log::nodes),
       column("loops", "loops", &Log::loops),
       error("error of its map [m]", "map.translation_error_m", &Log::map, &Error::translation_m, 4),
       error("[deg]", "map.rotation_error_deg", &Log::map, &Error::rotation_deg, 3),
       error("without loops [m]", "without_loops.translation_error_m", &Log::front_end, &Error::translation_m,
             4),
       error("[deg]", "without_loops.rotation_error_deg", &Log::front_end, &Error::rotation_deg, 3)},
      logs);
}

std::string markdown_of(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                        const std::string& machine) {
  const FalseLoopOptions how;
  const BentPathOptions slips;
  std::string text =
      "# How false loops are rejected\n\nThis page shows how many false loops, and how many slips of the "
      "front "
      "end, a pose graph tolerates. They are added to finished graphs, and the graphs are optimised "
      "again.\n\n" +
      measured_by(machine) + "; " + seeds_text(options.seeds) +
      " of the false loops and slips. Errors are means over the relations.\n\n";
  text +=
      "- share: number of false loops added to the finished graph, as a percentage of the loops accepted "
      "during mapping; of slips, the percentage of the path's stretches that are bent\n"
      "- scattered: join random nodes and path segments, at a random place and heading within " +
      fixed_text(how.reach_m, 0) +
      " m of the first node of the segment\n- groups: " + std::to_string(how.smallest_group) + " to " +
      std::to_string(how.largest_group) +
      " successive nodes agree on such a random place\n- nearby: true loops, shifted by " +
      fixed_text(how.min_error_m, 0) + " to " + fixed_text(how.nearby_m, 0) + " m and rotated by up to " +
      fixed_text(how.min_error_rad * 180 / M_PI, 0) + " degrees\n- slips: no false loops; stretches of " +
      std::to_string(slips.stretch_nodes) + " nodes of the front end's path are " +
      fixed_text(100 * slips.stretching, 0) + " % too long or too short, or turn " +
      fixed_text(slips.turn_rad * 180 / M_PI, 0) +
      " degrees too far to the left or to the right, without larger covariances\n"
      "- undefended: the graph is optimised with all loops\n"
      "- defended: outlier loops are rejected as in the mapper\n"
      "- from the map: as defended, but starts at the finished map. The other columns start at the poses "
      "before any loop was closed\n"
      "- kept / lost: false loops kept / true loops rejected\n"
      "- with several seeds, errors are mean ± sample standard deviation [worst] and other figures are "
      "means; each log is mapped once\n"
      "\n";
  return text + graphs_table(benchmark.logs).markdown() + '\n' + cases_table(benchmark).markdown() + '\n' +
         logs_section(benchmark.identities, benchmark.without_relations);
}

/// SVG plot of the error over the share of false loops of one kind. Each log has a line for the defended
/// graph, with bars from the least to the greatest error of the seeds, and a thin line for the undefended
/// graph.
std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind) {
  GrowthPlot plot;
  plot.title =
      "Error by the share of false loops or slips, " + name_of(kind) + " (dark: defended, light: undefended)";
  plot.unit = "m";
  plot.labels = {"0 %"};
  for (const FalseLoopLog& log : benchmark.logs) {
    GrowthPlot::Line defended;
    defended.name = log.name;
    GrowthPlot::Line undefended;
    undefended.faint = true;
    defended.values = undefended.values = {spread_of({log.map.translation_m})};
    for (const Trials& trials : cases_of(benchmark)) {
      const FalseLoopRow& first = trials.front();
      if (first.log != log.name || first.kind != kind) continue;
      if (plot.lines.empty()) plot.labels.push_back(fixed_text(first.share_percent, 0) + " %");
      defended.values.push_back(spread_of_trials(trials, &FalseLoopRow::defended, translation_error_m));
      undefended.values.push_back(
          spread_of({spread_of_trials(trials, &FalseLoopRow::undefended, translation_error_m).mean}));
    }
    plot.lines.push_back(std::move(defended));
    plot.lines.push_back(std::move(undefended));
  }
  return growth_svg(plot);
}

}  // namespace

BenchReport false_loop_report(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                              const std::string& machine) {
  const ReportTable cases = cases_table(benchmark);
  BenchReport report{"false-loops.md",
                     markdown_of(benchmark, options, machine),
                     json_file_text(report_json("psi-slam-false-loops", machine,
                                                {{"seeds", options.seeds.all()},
                                                 {"files", logs_table(benchmark.identities).json()},
                                                 {"logs", graphs_table(benchmark.logs).json()},
                                                 {"rows", cases.json()}})),
                     cases.csv(),
                     {}};
  for (const FalseLoopKind kind : options.kinds)
    report.plots.push_back({"false-loops-" + name_of(kind) + ".svg", false_loop_plot(benchmark, kind)});
  return report;
}

}  // namespace psi_slam
