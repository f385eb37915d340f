// SPDX-License-Identifier: BSD-3-Clause
#include "false_loops/false_loop_report.h"

#include <nlohmann/json.hpp>

#include "common/growth_plot.h"
#include "common/program_identity.h"
#include "batch/seed_spread.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

std::string cell(const std::string& text) {
  return ' ' + text + " |";
}

/// The trials of a share of a kind on a log, one a seed.
using Trials = std::vector<FalseLoopRow>;

std::vector<Trials> cases_of(const FalseLoopBenchmark& benchmark) {
  return by_case(benchmark.rows, [](const FalseLoopRow& a, const FalseLoopRow& b) {
    return a.log == b.log && a.kind == b.kind && a.share_percent == b.share_percent;
  });
}

/// What was made of the false loops in one way, over the seeds.
struct Outcomes {
  Outcomes(const Trials& trials, LoopTrialOutcome FalseLoopRow::*way)
      : translation_m(over(trials, way, [](const auto& one) { return one.error.translation_m; })),
        rotation_deg(over(trials, way, [](const auto& one) { return one.error.rotation_deg; })),
        false_kept(over(trials, way, [](const auto& one) { return one.false_kept; })),
        true_lost(over(trials, way, [](const auto& one) { return one.true_lost; })),
        milliseconds(over(trials, way, [](const auto& one) { return one.milliseconds; })) {}

  std::string counts() const {
    const int decimals = false_kept.count > 1 ? 1 : 0;
    return fixed_text(false_kept.mean, decimals) + " / " + fixed_text(true_lost.mean, decimals);
  }

  SeedSpread translation_m;
  SeedSpread rotation_deg;
  SeedSpread false_kept;
  SeedSpread true_lost;
  SeedSpread milliseconds;

 private:
  template <class ValueOf>
  static SeedSpread over(const Trials& trials, LoopTrialOutcome FalseLoopRow::*way, const ValueOf& value_of) {
    return spread_over(trials, [&](const FalseLoopRow& trial) { return value_of(trial.*way); });
  }
};

std::string row_text(const Trials& trials) {
  const FalseLoopRow& first = trials.front();
  const Outcomes undefended(trials, &FalseLoopRow::undefended);
  const Outcomes worst_first(trials, &FalseLoopRow::worst_first);
  const Outcomes defended(trials, &FalseLoopRow::defended);
  const Outcomes from_map(trials, &FalseLoopRow::from_map);
  return '|' + cell(first.log) + cell(name_of(first.kind)) + cell(fixed_text(first.share_percent, 0)) +
         cell(std::to_string(first.false_loops)) + cell(spread_text(undefended.translation_m, 3)) +
         cell(spread_text(worst_first.translation_m, 4)) + cell(worst_first.counts()) +
         cell(spread_text(defended.translation_m, 4)) + cell(spread_text(defended.rotation_deg, 3)) +
         cell(defended.counts()) + cell(fixed_text(defended.milliseconds.mean, 0)) +
         cell(spread_text(from_map.translation_m, 4)) + cell(from_map.counts()) + '\n';
}

std::string logs_text(const std::vector<FalseLoopLog>& logs) {
  std::string text =
      "| log | nodes | loops | error of its map [m] | [deg] | without loops [m] | [deg] |\n"
      "|---|---:|---:|---:|---:|---:|---:|\n";
  for (const FalseLoopLog& log : logs)
    text += '|' + cell(log.name) + cell(std::to_string(log.nodes)) + cell(std::to_string(log.loops)) +
            cell(fixed_text(log.map.translation_m, 4)) + cell(fixed_text(log.map.rotation_deg, 3)) +
            cell(fixed_text(log.front_end.translation_m, 4)) +
            cell(fixed_text(log.front_end.rotation_deg, 3)) + '\n';
  return text;
}

Json error_json(const LoopTrial::Error& error) {
  return {{"translation_error_m", error.translation_m}, {"rotation_error_deg", error.rotation_deg}};
}

Json outcomes_json(const Outcomes& outcomes) {
  return {{"translation_error_m", spread_json(outcomes.translation_m)},
          {"rotation_error_deg", spread_json(outcomes.rotation_deg)},
          {"false_kept", spread_json(outcomes.false_kept)},
          {"true_lost", spread_json(outcomes.true_lost)},
          {"time_ms", spread_json(outcomes.milliseconds)}};
}

Json row_json(const Trials& trials) {
  const FalseLoopRow& first = trials.front();
  return {{"log", first.log},
          {"kind", name_of(first.kind)},
          {"share_percent", first.share_percent},
          {"seeds", seeds_of(trials)},
          {"true_loops", first.true_loops},
          {"false_loops", first.false_loops},
          {"undefended", outcomes_json({trials, &FalseLoopRow::undefended})},
          {"worst_first", outcomes_json({trials, &FalseLoopRow::worst_first})},
          {"defended", outcomes_json({trials, &FalseLoopRow::defended})},
          {"from_map", outcomes_json({trials, &FalseLoopRow::from_map})}};
}

}  // namespace

std::string false_loop_markdown(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                                const std::string& machine) {
  const FalseLoopOptions how;
  std::string text = "# False loops survived\n\n" + measured_by(machine) + "; " + seeds_text(options.seeds) +
                     " of the false loops. Errors are means over the true relations.\n\n";
  text +=
      "- share: false loops added to the finished graph, in percent of the loops that the run accepted\n"
      "- scattered: between random nodes and local maps, at a random place and heading within " +
      fixed_text(how.reach_m, 0) + " m of the map's anchor\n- groups: " + std::to_string(how.smallest_group) +
      " to " + std::to_string(how.largest_group) +
      " successive nodes agree with each other on such a place\n- nearby: true loops, moved by " +
      fixed_text(how.min_error_m, 0) + " to " + fixed_text(how.nearby_m, 0) + " m and turned by up to " +
      fixed_text(how.min_error_rad * 180 / M_PI, 0) +
      " degrees\n"
      "- undefended: optimised with all of them; worst first: the worst are switched off until none is "
      "contradicted; defended: as psi-slam does it. All begin at the poses before any loop was closed; "
      "\"from the map\" begins at the finished map.\n"
      "- kept / lost: false loops that stay on / true ones that are switched off\n"
      "- of several seeds errors are mean ± standard deviation of the sample [worst], the other figures "
      "means; the logs are mapped once\n\n";
  text += logs_text(benchmark.logs);
  text +=
      "\n| log | kind | share % | false loops | undefended [m] | worst first [m] | kept / lost | defended "
      "[m] | "
      "[deg] | kept / lost | ms | from the map [m] | kept / lost |\n|---|---|";
  for (int column = 0; column < 11; ++column) text += "---:|";
  text += '\n';
  for (const Trials& trials : cases_of(benchmark)) text += row_text(trials);
  return text + '\n' + logs_markdown(benchmark.identities, benchmark.without_relations);
}

std::string false_loop_json(const FalseLoopBenchmark& benchmark, const FalseLoopBenchmarkOptions& options,
                            const std::string& machine) {
  Json logs = Json::array();
  for (const FalseLoopLog& log : benchmark.logs)
    logs.push_back({{"name", log.name},
                    {"nodes", log.nodes},
                    {"loops", log.loops},
                    {"map", error_json(log.map)},
                    {"without_loops", error_json(log.front_end)}});
  Json files = Json::array();
  for (const LogIdentity& log : benchmark.identities) files.push_back(log_json(log));
  Json rows = Json::array();
  for (const Trials& trials : cases_of(benchmark)) rows.push_back(row_json(trials));
  const Json json = {{"schema", "psi-slam-false-loops"},
                     {"schema_version", 1},
                     {"program_version", program_version()},
                     {"commit", program_commit()},
                     {"machine", machine},
                     {"seeds", options.seeds.all()},
                     {"files", files},
                     {"logs", logs},
                     {"rows", rows}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string false_loop_plot(const FalseLoopBenchmark& benchmark, FalseLoopKind kind) {
  GrowthPlot plot;
  plot.title = "Error by the share of false loops, " + name_of(kind) + " (dark: defended, light: not)";
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
      const SeedSpread errors = Outcomes(trials, &FalseLoopRow::defended).translation_m;
      defended.values.push_back(errors.mean);
      defended.low.push_back(errors.min);
      defended.high.push_back(errors.max);
      undefended.values.push_back(Outcomes(trials, &FalseLoopRow::undefended).translation_m.mean);
    }
    plot.lines.push_back(std::move(defended));
    plot.lines.push_back(std::move(undefended));
  }
  return growth_svg(plot);
}

}  // namespace psi_slam
