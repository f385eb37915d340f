// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_report.h"

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "batch/kept_run.h"
#include "batch/report_table.h"
#include "map/exports/csv_tables.h"
#include "map/report/html_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr int kErrorDecimals = 6;
constexpr int kTimeDecimals = 3;

constexpr const char* kStyle =
    "body{font:15px/1.5 system-ui,sans-serif;margin:2em auto;max-width:75em;padding:0 1em;color:#222}"
    "table{border-collapse:collapse}th,td{padding:.25em .8em;border-bottom:1px solid #ddd;text-align:right;"
    "font-variant-numeric:tabular-nums}.word{text-align:left}.best{font-weight:bold;background:#e8f3e8}";

const char* state_of(const std::optional<SweepOutcome>& outcome) {
  if (!outcome) return "to go";
  return outcome->figures ? "done" : "failed";
}

/// CSV fields with the figures of a run, in the order of kFigureHeads. The fields are empty if the run has no
/// figures.
std::vector<std::string> figure_fields(const std::optional<SweepOutcome>& outcome) {
  if (!outcome || !outcome->figures) return std::vector<std::string>(10);
  const SweepFigures& figures = *outcome->figures;
  std::vector<std::string> fields;
  for (const MeanAndStd& error : {figures.errors.translation_abs_m, figures.errors.rotation_abs_deg}) {
    fields.push_back(figures.has_errors ? fixed_text(error.mean, kErrorDecimals) : "");
    fields.push_back(figures.has_errors ? fixed_text(error.std, kErrorDecimals) : "");
  }
  fields.push_back(figures.has_errors ? std::to_string(figures.relations_used) : "");
  for (const std::size_t count :
       {figures.scans, figures.nodes, figures.loops_accepted, figures.loops_rejected})
    fields.push_back(std::to_string(count));
  fields.push_back(fixed_text(figures.path_length_m, kTimeDecimals));
  return fields;
}

constexpr const char* kFigureHeads =
    "translation_abs_m_mean,translation_abs_m_std,rotation_abs_deg_mean,rotation_abs_deg_std,relations_used,"
    "scans,nodes,loops_accepted,loops_rejected,path_length_m,";

std::string time_fields(const std::optional<SweepOutcome>& outcome) {
  if (!outcome || !outcome->figures) return ",,,";
  const SweepFigures& figures = *outcome->figures;
  return ',' + fixed_text(figures.wall_s, kTimeDecimals) + ',' + fixed_text(figures.cpu_s, kTimeDecimals) +
         ',' + fixed_text(figures.peak_memory_mib, 1);
}

/// Summary above the tables of the report.
std::string account_text(const SweepPlan& plan, const SweepResult& result) {
  const auto runs = counted(plan.runs.size(), "run", "runs");
  const auto logs = counted(plan.logs.size(), "log", "logs");
  std::string text = runs + " of " + logs + ": mean ± standard deviation over the seeds";
  if (result.failed() > 0) text += "; " + counted(result.failed(), "run", "runs") + " failed";
  if (result.to_go() > 0) text += "; " + std::to_string(result.to_go()) + " not made yet";
  return text + ". Errors are means over the true relations; the smallest error of each log is marked.";
}

/// The runs of one log with one setting, one for each seed.
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

/// A column of numbers in the report: one figure of the runs.
struct Measure {
  const char* head;
  double (*value_of)(const SweepFigures&);
  int decimals;
  bool is_error = false;  ///< known only with true relations; the smallest value is the best
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

/// Returns whether several groups of the log have a mean of the measure and this group has the smallest.
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

ReportTable by_setting(const std::vector<Measure>& measures, const SweepPlan& plan,
                       const SweepResult& result) {
  ReportTable table;
  table.columns.push_back({"log", {}, true});
  for (const std::string& column : plan.columns) table.columns.push_back({column, {}, true});
  table.columns.push_back({"runs"});
  for (const Measure& measure : measures) table.columns.push_back({measure.head});
  const std::vector<Group> groups = groups_of(plan, result);
  for (const Group& group : groups) {
    std::vector<ReportCell> row{cell(plan.logs[group.first->log].name)};
    for (const std::string& value : group.first->values) row.push_back(cell(value));
    const std::string finished = std::to_string(group.finished.size());
    row.push_back(cell(group.finished.size() == group.runs ? finished
                                                           : finished + " of " + std::to_string(group.runs)));
    for (const Measure& measure : measures)
      row.push_back(
          {mean_and_std(spread_of(measure, group), measure.decimals), {}, is_best(measure, group, groups)});
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable failures_table(const SweepPlan& plan, const SweepResult& result) {
  ReportTable table{{{"run", {}, true}, {"attempts", {}, true}, {"reason", {}, true}}, {}};
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const std::optional<SweepOutcome>& outcome = result.outcomes[i];
    if (outcome && !outcome->figures)
      table.rows.push_back({cell(plan.runs[i].folder), cell(static_cast<std::size_t>(outcome->attempts)),
                            cell(outcome->failure)});
  }
  return table;
}

std::vector<std::pair<std::string, ReportTable>> titled_tables(const SweepPlan& plan,
                                                               const SweepResult& result) {
  using Figures = SweepFigures;
  const std::vector<Measure> results{
      {"translation [m]", [](const Figures& f) { return f.errors.translation_abs_m.mean; }, 4, true},
      {"rotation [deg]", [](const Figures& f) { return f.errors.rotation_abs_deg.mean; }, 3, true},
      {"nodes", [](const Figures& f) { return static_cast<double>(f.nodes); }, 1},
      {"loops", [](const Figures& f) { return static_cast<double>(f.loops_accepted); }, 1},
      {"rejected", [](const Figures& f) { return static_cast<double>(f.loops_rejected); }, 1},
      {"path [m]", [](const Figures& f) { return f.path_length_m; }, 2}};
  const std::vector<Measure> times{{"time [s]", [](const Figures& f) { return f.wall_s; }, 2},
                                   {"processor time [s]", [](const Figures& f) { return f.cpu_s; }, 2},
                                   {"memory [MiB]", [](const Figures& f) { return f.peak_memory_mib; }, 0}};
  std::vector<std::pair<std::string, ReportTable>> tables{{"By setting", by_setting(results, plan, result)}};
  ReportTable failures = failures_table(plan, result);
  if (!failures.rows.empty()) tables.emplace_back("Failed runs", std::move(failures));
  tables.emplace_back("Times", by_setting(times, plan, result));
  return tables;
}

Json log_json(const SweepLog& log) {
  Json json = {{"name", log.name}, {"file", log.log.string()}, {"sha256", log.sha256}};
  json["ini"] = log.ini.empty() ? Json(nullptr) : Json(log.ini.string());
  json["relations"] = log.relations ? Json(log.relations->string()) : Json(nullptr);
  json["relations_sha256"] = log.relations ? Json(log.relations_sha256) : Json(nullptr);
  return json;
}

Json run_json(const SweepPlan& plan, const SweepRun& run, const std::optional<SweepOutcome>& outcome) {
  Json values = Json::object();
  for (std::size_t i = 0; i < plan.columns.size(); ++i) values[plan.columns[i]] = run.values[i];
  Json json = {{"log", plan.logs[run.log].name}, {"settings", values}, {"seed", run.seed},
               {"folder", "runs/" + run.folder}, {"key", run.key},     {"state", state_of(outcome)}};
  json["failure"] = outcome && !outcome->figures ? Json(outcome->failure) : Json(nullptr);
  json["figures"] = nullptr;
  if (!outcome || !outcome->figures) return json;
  const SweepFigures& figures = *outcome->figures;
  json["figures"] = run_figures_json(figures);
  if (!figures.has_errors) json["figures"]["errors"] = nullptr;
  SweepFigures::visit_map(figures,
                          [&json](const char* key, const auto& value) { json["figures"][key] = value; });
  return json;
}

}  // namespace

std::string sweep_csv(const SweepPlan& plan, const SweepResult& result) {
  std::string text = "log,";
  for (const std::string& column : plan.columns) text += csv_field(column) + ',';
  text += std::string("seed,state,") + kFigureHeads + "folder,failure,wall_s,cpu_s,peak_memory_mib\n";
  for (std::size_t i = 0; i < plan.runs.size(); ++i) {
    const SweepRun& run = plan.runs[i];
    const std::optional<SweepOutcome>& outcome = result.outcomes[i];
    text += csv_field(plan.logs[run.log].name) + ',';
    for (const std::string& value : run.values) text += csv_field(value) + ',';
    text += std::to_string(run.seed) + ',' + state_of(outcome) + ',';
    for (const std::string& field : figure_fields(outcome)) text += field + ',';
    text += csv_field("runs/" + run.folder) + ',' + csv_field(outcome ? outcome->failure : "") +
            time_fields(outcome) + '\n';
  }
  return text;
}

std::string sweep_json(const SweepPlan& plan, const SweepResult& result) {
  Json logs = Json::array();
  for (const SweepLog& log : plan.logs) logs.push_back(log_json(log));
  Json runs = Json::array();
  for (std::size_t i = 0; i < plan.runs.size(); ++i)
    runs.push_back(run_json(plan, plan.runs[i], result.outcomes[i]));
  const Json json = {{"schema", "psi-slam-sweep"},
                     {"schema_version", 2},
                     {"logs", logs},
                     {"varies", plan.columns},
                     {"runs", runs}};
  return json_file_text(json);
}

std::string sweep_markdown(const SweepPlan& plan, const SweepResult& result) {
  std::string text = "# Sweep\n\n" + account_text(plan, result) + '\n';
  for (const auto& [title, table] : titled_tables(plan, result))
    text += "\n## " + title + "\n\n" + table.markdown();
  return text;
}

std::string sweep_html(const SweepPlan& plan, const SweepResult& result) {
  std::string text = std::string("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"/>") +
                     "<title>Sweep – psi-slam</title>\n<style>" + kStyle + "</style></head>\n<body>\n" +
                     "<h1>Sweep</h1>\n<p>" + escape_html(account_text(plan, result)) + "</p>\n";
  for (const auto& [title, table] : titled_tables(plan, result))
    text += "<h2>" + title + "</h2>\n" + table.html();
  return text + "</body>\n</html>\n";
}

void write_sweep_report(const SweepPlan& plan, const SweepResult& result,
                        const std::filesystem::path& folder) {
  write_text_atomically(folder / "sweep.csv", sweep_csv(plan, result));
  write_text_atomically(folder / "sweep.json", sweep_json(plan, result));
  write_text_atomically(folder / "report.md", sweep_markdown(plan, result));
  write_text_atomically(folder / "report.html", sweep_html(plan, result));
}

}  // namespace psi_slam
