// SPDX-License-Identifier: BSD-3-Clause
// A table of a report that writes itself as Markdown, HTML, JSON and CSV.
#pragma once

#include <cstddef>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "batch/seeds.h"

namespace psi_slam {

/// One value: as text for Markdown and HTML, as data for JSON and CSV.
struct ReportCell {
  std::string text;
  nlohmann::ordered_json value;  ///< discarded: the row has no such member in JSON
  bool best = false;             ///< bold
};

ReportCell cell(const std::string& text);
ReportCell cell(std::size_t count);
ReportCell cell(double value, int decimals);
/// Factor times the value as text, the value itself as data; "–" and null without a value.
ReportCell cell(const std::optional<double>& value, int decimals, double factor = 1);
/// spread_text() and spread_json().
ReportCell cell(const SeedSpread& spread, int decimals);
/// "–" as text and no data.
ReportCell empty_cell();

struct ReportColumn {
  std::string head;      ///< head in Markdown and HTML; empty: the column is missing there
  std::string key{};     ///< name in JSON and CSV; empty: the column is missing there. "a.b" is member b of a
  bool is_text = false;  ///< left-aligned
};

struct ReportTable {
  std::vector<ReportColumn> columns;
  std::vector<std::vector<ReportCell>> rows;  ///< a cell for each column

  std::string markdown() const;
  std::string html() const;
  /// An array with an object for each row.
  nlohmann::ordered_json json() const;
  /// A head and a line for each row. Members of objects are columns of their own, named by their path:
  /// "a.mean". Elements of arrays are separated by spaces.
  std::string csv() const;
};

/// A column and how its cell follows from a row.
template <class Row>
struct ColumnOf {
  ReportColumn column;
  std::function<ReportCell(const Row&)> cell_of;
};

/// Columns of a member of the rows: a text, a count, or a number with `decimals`.
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
