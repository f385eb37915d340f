// SPDX-License-Identifier: BSD-3-Clause
// A table of a report, with output as Markdown, HTML, JSON and CSV.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "batch/seeds.h"

namespace psi_slam {

/// One cell of a table: a text for Markdown and HTML, a value for JSON and CSV.
struct ReportCell {
  std::string text;
  nlohmann::ordered_json value;  ///< a discarded value is left out of the JSON object of the row
  bool best = false;             ///< shown in bold
};

ReportCell cell(const std::string& text);
ReportCell cell(std::size_t count);
ReportCell cell(double value, int decimals);
/// Cell with `factor` times the value as text and the value itself as data. Without a value: "–" and null.
ReportCell cell(const std::optional<double>& value, int decimals, double factor = 1);
/// Cell with spread_text() as text and spread_json() as data.
ReportCell cell(const SeedSpread& spread, int decimals);
/// Cell with "–" as text and no data.
ReportCell empty_cell();

struct ReportColumn {
  std::string head;      ///< head in Markdown and HTML; empty: the column is missing there
  std::string key{};     ///< name in JSON and CSV; empty: the column is missing there. "a.b" is member b of a
  bool is_text = false;  ///< left-aligned, as texts are
};

struct ReportTable {
  std::vector<ReportColumn> columns;
  std::vector<std::vector<ReportCell>> rows;  ///< each row has a cell for each column

  std::string markdown() const;
  std::string html() const;
  /// An array with an object for each row.
  nlohmann::ordered_json json() const;
  /// A header line, then a line for each row. Each member of a JSON object has a column of its own, named by
  /// its path: "a.mean". Elements of arrays are separated by spaces.
  std::string csv() const;
};

/// A column, and the function that makes its cell from a row.
template <class Row>
struct ColumnOf {
  ReportColumn column;
  std::function<ReportCell(const Row&)> cell_of;
};

/// Column with one member of each row: a text, a count, or a number with `decimals` decimals.
template <class Row>
ColumnOf<Row> column(const std::string& head, const std::string& key, std::string Row::*text) {
  return {{head, key, true}, [=](const Row& row) { return cell(row.*text); }};
}
template <class Row>
ColumnOf<Row> column(const std::string& head, const std::string& key, std::size_t Row::*count) {
  return {{head, key}, [=](const Row& row) { return cell(row.*count); }};
}
template <class Row>
ColumnOf<Row> column(const std::string& head, const std::string& key, double Row::*value, int decimals) {
  return {{head, key}, [=](const Row& row) { return cell(row.*value, decimals); }};
}

template <class Row>
ReportTable table_of(const std::vector<ColumnOf<Row>>& columns, const std::vector<Row>& rows) {
  ReportTable table;
  for (const ColumnOf<Row>& column : columns) table.columns.push_back(column.column);
  for (const Row& row : rows) {
    std::vector<ReportCell>& cells = table.rows.emplace_back();
    for (const ColumnOf<Row>& column : columns) cells.push_back(column.cell_of(row));
  }
  return table;
}

}  // namespace psi_slam
