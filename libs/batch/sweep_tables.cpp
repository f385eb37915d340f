// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_tables.h"

#include "batch/seed_spread.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

/// The runs of one log with one setting, by seed.
struct Group {
  const SweepRun* first = nullptr;
  std::size_t runs = 0;
  std::vector<SweepFigures> finished;
};

std::vector<Group> groups_of(const SweepPlan& plan, const SweepResult& result) {
  std::vector<Group> groups;
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const SweepRun& run = plan.runs[i];
    if (groups.empty() || groups.back().first->log != run.log || groups.back().first->values != run.values)
      groups.push_back({&run, 0, {}});
    ++groups.back().runs;
    if (result.outcomes[i] && result.outcomes[i]->figures)
      groups.back().finished.push_back(*result.outcomes[i]->figures);
  }
  return groups;
}

/// A column of numbers.
struct Measure {
  const char* head;
  double (*value_of)(const SweepFigures&);
  int decimals;
  bool is_error = false;  ///< there only where there are relations, and the smallest is the best
};

SeedSpread spread_of(const Measure& measure, const Group& group) {
  if (measure.is_error && !group.finished.empty() && !group.finished.front().has_errors) return {};
  return spread_over(group.finished, measure.value_of);
}

std::string mean_and_std(const SeedSpread& spread, int decimals) {
  if (spread.count == 0) return "–";
  const std::string mean = fixed_text(spread.mean, decimals);
  return spread.count == 1 ? mean : mean + " ± " + fixed_text(spread.std, decimals);
}

/// Whether no other setting of the log has a smaller mean, and there is one to compare with.
bool is_best(const Measure& measure, const Group& group, const std::vector<Group>& groups) {
  const SeedSpread own = spread_of(measure, group);
  bool compared = false;
  if (!measure.is_error || own.count == 0) return false;
  for (const Group& other : groups) {
    const SeedSpread its = spread_of(measure, other);
    if (&other == &group || other.first->log != group.first->log || its.count == 0) continue;
    if (its.mean < own.mean) return false;
    compared = true;
  }
  return compared;
}

SweepTable table_of(const std::string& title, const std::vector<Measure>& measures, const SweepPlan& plan,
                    const SweepResult& result) {
  SweepTable table;
  table.title = title;
  table.heads = {"log"};
  table.heads.insert(table.heads.end(), plan.columns.begin(), plan.columns.end());
  table.words = table.heads.size();
  table.heads.emplace_back("runs");
  for (const Measure& measure : measures) table.heads.emplace_back(measure.head);
  const std::vector<Group> groups = groups_of(plan, result);
  for (const Group& group : groups) {
    std::vector<SweepCell> row{{plan.logs[group.first->log].name}};
    for (const std::string& value : group.first->values) row.push_back({value});
    const std::string finished = std::to_string(group.finished.size());
    row.push_back(
        {group.finished.size() == group.runs ? finished : finished + " of " + std::to_string(group.runs)});
    for (const Measure& measure : measures)
      row.push_back(
          {mean_and_std(spread_of(measure, group), measure.decimals), is_best(measure, group, groups)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

SweepTable results_table(const SweepPlan& plan, const SweepResult& result) {
  const std::vector<Measure> measures{
      {"translation [m]", [](const SweepFigures& f) { return f.errors.translation_abs_m.mean; }, 4, true},
      {"rotation [deg]", [](const SweepFigures& f) { return f.errors.rotation_abs_deg.mean; }, 3, true},
      {"nodes", [](const SweepFigures& f) { return static_cast<double>(f.nodes); }, 1},
      {"loops", [](const SweepFigures& f) { return static_cast<double>(f.loops_accepted); }, 1},
      {"refused", [](const SweepFigures& f) { return static_cast<double>(f.loops_refused); }, 1},
      {"switched off", [](const SweepFigures& f) { return static_cast<double>(f.loops_switched_off); }, 1},
      {"path [m]", [](const SweepFigures& f) { return f.path_length_m; }, 2}};
  return table_of("By setting", measures, plan, result);
}

SweepTable times_table(const SweepPlan& plan, const SweepResult& result) {
  const std::vector<Measure> measures{
      {"time [s]", [](const SweepFigures& f) { return f.wall_s; }, 2},
      {"processor time [s]", [](const SweepFigures& f) { return f.cpu_s; }, 2},
      {"memory [MiB]", [](const SweepFigures& f) { return f.peak_memory_mib; }, 0}};
  return table_of("Times", measures, plan, result);
}

SweepTable failures_table(const SweepPlan& plan, const SweepResult& result) {
  SweepTable table{"Failed runs", {"run", "attempts", "why"}, 3, {}};
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const std::optional<SweepOutcome>& outcome = result.outcomes[i];
    if (outcome && !outcome->figures)
      table.rows.push_back({{plan.runs[i].folder}, {std::to_string(outcome->attempts)}, {outcome->failure}});
  }
  return table;
}

}  // namespace psi_slam
