// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_report.h"

#include <cmath>

#include "base/number_text.h"
#include "batch/kept_run.h"
#include "common/log_plots.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

/// The trials of one share of one kind on a log, one for each seed.
using Trials = std::vector<FalseLoopRow>;

std::vector<Trials> cases_of(const FalseLoopBenchmark& benchmark) {
  return by_case(benchmark.rows, [](const FalseLoopRow& a, const FalseLoopRow& b) {
    return a.log == b.log && a.kind == b.kind && a.share_percent == b.share_percent;
  });
}

/// How a trial treats the false loops.
using Treatment = LoopTrialOutcome FalseLoopRow::*;

using Column = ColumnOf<Trials>;

/// A column with the statistics of one figure of a treatment.
template <class ValueOf>
Column figure_column(const std::string& head, const std::string& key, Treatment treatment, int decimals,
                     const ValueOf& value_of) {
  return {{head, key}, [=](const Trials& trials) {
            const auto of_trial = [&](const FalseLoopRow& trial) { return value_of(trial.*treatment); };
            return cell(spread_over(trials, of_trial), decimals);
          }};
}

SeedSpread translation_error_m(const Trials& trials, Treatment treatment) {
  return spread_over(trials,
                     [&](const FalseLoopRow& trial) { return (trial.*treatment).error.translation_m; });
}

/// The columns of a treatment named `key` in JSON. An empty head is missing in Markdown.
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
  const Treatment treatment = of.treatment;
  columns.push_back(
      figure_column(of.translation_head, of.key + ".translation_error_m", treatment, of.translation_decimals,
                    [](const LoopTrialOutcome& outcome) { return outcome.error.translation_m; }));
  columns.push_back(
      figure_column(of.rotation_head, of.key + ".rotation_error_deg", treatment, 3,
                    [](const LoopTrialOutcome& outcome) { return outcome.error.rotation_deg; }));
  const auto false_kept = [](const LoopTrialOutcome& outcome) { return outcome.false_kept; };
  const auto true_lost = [](const LoopTrialOutcome& outcome) { return outcome.true_lost; };
  columns.push_back(
      {{of.counts_head}, [=](const Trials& trials) {
         const auto mean = [&](const auto& count) {
           return spread_over(trials, [&](const auto& trial) { return count(trial.*treatment); }).mean;
         };
         const int decimals = trials.size() > 1 ? 1 : 0;
         return cell(fixed_text(mean(false_kept), decimals) + " / " + fixed_text(mean(true_lost), decimals));
       }});
  columns.push_back(figure_column({}, of.key + ".false_kept", treatment, 1, false_kept));
  columns.push_back(figure_column({}, of.key + ".true_lost", treatment, 1, true_lost));
  columns.push_back({{of.time_head, of.key + ".time_ms"}, [=](const Trials& trials) {
                       const SeedSpread time_ms = spread_over(
                           trials, [&](const auto& trial) { return (trial.*treatment).milliseconds; });
                       return ReportCell{fixed_text(time_ms.mean, 0), spread_json(time_ms)};
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
      {{"false loops", "false_loops"},
       [](const Trials& trials) { return cell(trials.front().false_loops); }}};
  add_columns({&FalseLoopRow::undefended, "undefended", "undefended [m]", 3}, columns);
  add_columns({&FalseLoopRow::worst_first, "worst_first", "worst first [m]", 4, {}, "kept / lost"}, columns);
  add_columns({&FalseLoopRow::defended, "defended", "defended [m]", 4, "[deg]", "kept / lost", "ms"},
              columns);
  add_columns({&FalseLoopRow::from_map, "from_map", "from the map [m]", 4, {}, "kept / lost"}, columns);
  return table_of(columns, cases_of(benchmark));
}

ReportTable graphs_table(const std::vector<FalseLoopLog>& logs) {
  using Log = FalseLoopLog;
  return table_of<Log>(
      {{{"log", "name", true}, [](const Log& log) { return cell(log.name); }},
       {{"nodes", "nodes"}, [](const Log& log) { return cell(log.nodes); }},
       {{"loops", "loops"}, [](const Log& log) { return cell(log.loops); }},
       {{"error of its map [m]", "map.translation_error_m"},
        [](const Log& log) { return cell(log.map.translation_m, 4); }},
       {{"[deg]", "map.rotation_error_deg"}, [](const Log& log) { return cell(log.map.rotation_deg, 3); }},
       {{"without loops [m]", "without_loops.translation_error_m"},
        [](const Log& log) { return cell(log.front_end.translation_m, 4); }},
       {{"[deg]", "without_loops.rotation_error_deg"},
        [](const Log& log) { return cell(log.front_end.rotation_deg, 3); }}},
      logs);
}

std::string markdown_of(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                        const std::string& machine) {
  const FalseLoopOptions how;
  std::string text =
      "# How false loops are rejected\n\nThis page shows how many false loops a pose graph tolerates. False "
      "loops are added to finished graphs, and the graphs are optimised again.\n\n" +
      measured_by(machine) + "; " + seeds_text(options.seeds) +
      " of the false loops. Errors are means over the true relations.\n\n";
  text +=
      "- share: number of false loops added to the finished graph, as a percentage of the loops accepted "
      "during mapping\n"
      "- scattered: join random nodes and local maps, at a random place and heading within " +
      fixed_text(how.reach_m, 0) +
      " m of the "
      "anchor of the local map\n"
      "- groups: " +
      std::to_string(how.smallest_group) + " to " + std::to_string(how.largest_group) +
      " successive nodes agree on such a random place\n"
      "- nearby: true loops, shifted by " +
      fixed_text(how.min_error_m, 0) + " to " + fixed_text(how.nearby_m, 0) + " m and rotated by up to " +
      fixed_text(how.min_error_rad * 180 / M_PI, 0) +
      " degrees\n"
      "- undefended: the graph is optimised with all loops\n"
      "- worst first: the loops with the worst residuals are rejected until no outlier loop is left\n"
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

Json json_of(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
             const std::string& machine) {
  Json json = report_json("psi-slam-false-loops", machine);
  json.update({{"seeds", options.seeds.all()},
               {"files", logs_table(benchmark.identities).json()},
               {"logs", graphs_table(benchmark.logs).json()},
               {"rows", cases_table(benchmark).json()}});
  return json;
}

}  // namespace

BenchReport false_loop_report(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                              const std::string& machine) {
  BenchReport report{"false-loops.md",
                     markdown_of(benchmark, options, machine),
                     json_file_text(json_of(benchmark, options, machine)),
                     cases_table(benchmark).csv(),
                     {}};
  for (const FalseLoopKind kind : options.kinds)
    report.plots.push_back({"false-loops-" + name_of(kind) + ".svg", false_loop_plot(benchmark, kind)});
  return report;
}

std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind) {
  GrowthPlot plot;
  plot.title = "Error by the share of false loops, " + name_of(kind) + " (dark: defended, light: undefended)";
  plot.unit = "m";
  plot.labels = {"0 %"};
  for (const FalseLoopLog& log : benchmark.logs) {
    GrowthPlot::Line defended;
    defended.name = log.name;
    GrowthPlot::Line undefended;
    undefended.faint = true;
    for (std::vector<double>* values : {&defended.values, &defended.low, &defended.high, &undefended.values})
      values->push_back(log.map.translation_m);
    for (const Trials& trials : cases_of(benchmark)) {
      const FalseLoopRow& first = trials.front();
      if (first.log != log.name || first.kind != kind) continue;
      if (plot.lines.empty()) plot.labels.push_back(fixed_text(first.share_percent, 0) + " %");
      const SeedSpread errors = translation_error_m(trials, &FalseLoopRow::defended);
      defended.values.push_back(errors.mean);
      defended.low.push_back(errors.min);
      defended.high.push_back(errors.max);
      undefended.values.push_back(translation_error_m(trials, &FalseLoopRow::undefended).mean);
    }
    plot.lines.push_back(std::move(defended));
    plot.lines.push_back(std::move(undefended));
  }
  return growth_svg(plot);
}

}  // namespace psi_slam
