// SPDX-License-Identifier: BSD-3-Clause
#include "batch/sweep_report.h"

#include <nlohmann/json.hpp>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "batch/markdown_cells.h"
#include "batch/sweep_tables.h"
#include "exports/csv_tables.h"
#include "report/html_text.h"

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

/// The fields behind a run's state, up to its times.
std::vector<std::string> figure_fields(const std::optional<SweepOutcome>& outcome) {
  if (!outcome || !outcome->figures) return std::vector<std::string>(11);
  const SweepFigures& figures = *outcome->figures;
  std::vector<std::string> fields;
  for (const MeanAndStd& error : {figures.errors.translation_abs_m, figures.errors.rotation_abs_deg}) {
    fields.push_back(figures.has_errors ? fixed_text(error.mean, kErrorDecimals) : "");
    fields.push_back(figures.has_errors ? fixed_text(error.std, kErrorDecimals) : "");
  }
  fields.push_back(figures.has_errors ? std::to_string(figures.relations_used) : "");
  for (const std::size_t count : {figures.scans, figures.nodes, figures.loops_accepted, figures.loops_refused,
                                  figures.loops_switched_off})
    fields.push_back(std::to_string(count));
  fields.push_back(fixed_text(figures.path_length_m, kTimeDecimals));
  return fields;
}

constexpr const char* kFigureHeads =
    "translation_abs_m_mean,translation_abs_m_std,rotation_abs_deg_mean,rotation_abs_deg_std,relations_used,"
    "scans,nodes,loops_accepted,loops_refused,loops_switched_off,path_length_m,";

std::string time_fields(const std::optional<SweepOutcome>& outcome) {
  if (!outcome || !outcome->figures) return ",,,";
  const SweepFigures& figures = *outcome->figures;
  return ',' + fixed_text(figures.wall_s, kTimeDecimals) + ',' + fixed_text(figures.cpu_s, kTimeDecimals) +
         ',' + fixed_text(figures.peak_memory_mib, 1);
}

/// What there is to be told above the tables.
std::string account_text(const SweepPlan& plan, const SweepResult& result) {
  const auto runs = counted(plan.runs.size(), "run", "runs");
  const auto logs = counted(plan.logs.size(), "log", "logs");
  std::string text = runs + " of " + logs + ": mean ± standard deviation over the seeds";
  if (result.failed() > 0) text += "; " + counted(result.failed(), "run", "runs") + " failed";
  if (result.to_go() > 0) text += "; " + std::to_string(result.to_go()) + " not made yet";
  return text + ". Errors are means over the relations known to be true; the smallest of a log is marked.";
}

std::vector<SweepTable> tables_of(const SweepPlan& plan, const SweepResult& result) {
  std::vector<SweepTable> tables{results_table(plan, result)};
  const SweepTable failures = failures_table(plan, result);
  if (!failures.rows.empty()) tables.push_back(failures);
  tables.push_back(times_table(plan, result));
  return tables;
}

std::string markdown_of(const SweepTable& table) {
  std::string text = "\n## " + table.title + "\n\n|";
  for (const std::string& head : table.heads) text += ' ' + cell_text(head) + " |";
  text += "\n|" + repeated("---|", table.words) + repeated("---:|", table.heads.size() - table.words) + '\n';
  for (const std::vector<SweepCell>& row : table.rows) {
    text += '|';
    for (const SweepCell& cell : row) {
      const char* const mark = cell.best ? "**" : "";
      text += std::string(" ") + mark + cell_text(cell.text) + mark + " |";
    }
    text += '\n';
  }
  return text;
}

std::string html_of(const SweepTable& table) {
  const auto tag = [&](std::size_t column, const char* name, bool best) {
    std::string kind = column < table.words ? "word" : "";
    if (best) kind += kind.empty() ? "best" : " best";
    return std::string("<") + name + (kind.empty() ? "" : " class=\"" + kind + '"') + '>';
  };
  std::string text = "<h2>" + escape_html(table.title) + "</h2>\n<table>\n<tr>";
  for (std::size_t i = 0; i < table.heads.size(); ++i)
    text += tag(i, "th", false) + escape_html(table.heads[i]) + "</th>";
  text += "</tr>\n";
  for (const std::vector<SweepCell>& row : table.rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      text += tag(i, "td", row[i].best) + escape_html(row[i].text) + "</td>";
    text += "</tr>\n";
  }
  return text + "</table>\n";
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
  json["figures"].update({{"nodes", figures.nodes},
                          {"loops_accepted", figures.loops_accepted},
                          {"loops_refused", figures.loops_refused},
                          {"loops_switched_off", figures.loops_switched_off},
                          {"path_length_m", figures.path_length_m}});
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
                     {"schema_version", 1},
                     {"logs", logs},
                     {"varies", plan.columns},
                     {"runs", runs}};
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

std::string sweep_markdown(const SweepPlan& plan, const SweepResult& result) {
  std::string text = "# Sweep\n\n" + account_text(plan, result) + '\n';
  for (const SweepTable& table : tables_of(plan, result)) text += markdown_of(table);
  return text;
}

std::string sweep_html(const SweepPlan& plan, const SweepResult& result) {
  std::string text = std::string("<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"/>") +
                     "<title>Sweep – psi-slam</title>\n<style>" + kStyle + "</style></head>\n<body>\n" +
                     "<h1>Sweep</h1>\n<p>" + escape_html(account_text(plan, result)) + "</p>\n";
  for (const SweepTable& table : tables_of(plan, result)) text += html_of(table);
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
