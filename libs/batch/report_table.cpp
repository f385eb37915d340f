// SPDX-License-Identifier: BSD-3-Clause
#include "batch/report_table.h"

#include <algorithm>
#include <map>

#include "base/number_text.h"
#include "map/exports/csv_tables.h"
#include "map/report/html_text.h"

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kNoValue = "–";

/// Text for one cell of a Markdown table: line ends become spaces, bars become slashes.
std::string one_line(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  std::replace(text.begin(), text.end(), '|', '/');
  return text;
}

std::string scalar_text(const Json& value) {
  return value.is_string() ? value.get<std::string>() : value.dump();
}

/// Adds each scalar value within `value` to `fields` under its path, and new paths to `paths`. Skips nulls.
void add_fields(const std::string& path, const Json& value, std::map<std::string, std::string>& fields,
                std::vector<std::string>& paths) {
  if (value.is_null() || value.is_discarded()) return;
  if (value.is_object() || (value.is_array() && !value.empty() && value.front().is_object())) {
    for (const auto& [key, member] : value.items()) add_fields(path + '.' + key, member, fields, paths);
    return;
  }
  std::string text;
  if (value.is_array())
    for (const Json& element : value) text += (text.empty() ? "" : " ") + scalar_text(element);
  else
    text = scalar_text(value);
  if (std::find(paths.begin(), paths.end(), path) == paths.end()) paths.push_back(path);
  fields[path] = text;
}

}  // namespace

ReportCell cell(const std::string& text) {
  return {text, text};
}

ReportCell cell(std::size_t count) {
  return {std::to_string(count), count};
}

ReportCell cell(double value, int decimals) {
  return {fixed_text(value, decimals), value};
}

ReportCell cell(const std::optional<double>& value, int decimals, double factor) {
  if (!value) return {kNoValue, nullptr};
  return {fixed_text(factor * *value, decimals), *value};
}

ReportCell cell(const SeedSpread& spread, int decimals) {
  return {spread_text(spread, decimals), spread_json(spread)};
}

ReportCell empty_cell() {
  return {kNoValue, Json(Json::value_t::discarded)};
}

std::string ReportTable::markdown() const {
  std::string heads = "|";
  std::string rule = "|";
  for (const ReportColumn& column : columns) {
    if (column.head.empty()) continue;
    heads += ' ' + one_line(column.head) + " |";
    rule += column.is_text ? "---|" : "---:|";
  }
  std::string text = heads + '\n' + rule + '\n';
  for (const std::vector<ReportCell>& row : rows) {
    text += '|';
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].head.empty()) continue;
      const char* const mark = row[i].best ? "**" : "";
      text += std::string(" ") + mark + one_line(row[i].text) + mark + " |";
    }
    text += '\n';
  }
  return text;
}

std::string ReportTable::html() const {
  const auto element = [](const ReportColumn& column, const std::string& name, const std::string& content,
                          bool best) {
    std::string kind = column.is_text ? "word" : "";
    if (best) kind += kind.empty() ? "best" : " best";
    return '<' + name + (kind.empty() ? "" : " class=\"" + kind + '"') + '>' + escape_html(content) + "</" +
           name + '>';
  };
  std::string text = "<table>\n<tr>";
  for (const ReportColumn& column : columns)
    if (!column.head.empty()) text += element(column, "th", column.head, false);
  text += "</tr>\n";
  for (const std::vector<ReportCell>& row : rows) {
    text += "<tr>";
    for (std::size_t i = 0; i < columns.size(); ++i)
      if (!columns[i].head.empty()) text += element(columns[i], "td", row[i].text, row[i].best);
    text += "</tr>\n";
  }
  return text + "</table>\n";
}

Json ReportTable::json() const {
  Json list = Json::array();
  for (const std::vector<ReportCell>& row : rows) {
    Json object = Json::object();
    for (std::size_t i = 0; i < columns.size(); ++i) {
      if (columns[i].key.empty() || row[i].value.is_discarded()) continue;
      std::string path = '/' + columns[i].key;
      std::replace(path.begin(), path.end(), '.', '/');
      object[Json::json_pointer(path)] = row[i].value;
    }
    list.push_back(std::move(object));
  }
  return list;
}

std::string ReportTable::csv() const {
  std::vector<std::map<std::string, std::string>> lines(rows.size());
  std::vector<std::string> paths;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    if (columns[i].key.empty()) continue;
    for (std::size_t row = 0; row < rows.size(); ++row)
      add_fields(columns[i].key, rows[row][i].value, lines[row], paths);
  }
  std::string text;
  for (const std::string& path : paths) text += (text.empty() ? "" : ",") + csv_field(path);
  text += '\n';
  for (std::map<std::string, std::string>& line : lines) {
    for (const std::string& path : paths) text += (path == paths.front() ? "" : ",") + csv_field(line[path]);
    text += '\n';
  }
  return text;
}

}  // namespace psi_slam
