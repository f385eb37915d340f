// SPDX-License-Identifier: BSD-3-Clause
#include "matching/bound_tables.h"

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "matching/score_grid.h"

namespace psi_slam {
namespace {

struct HalfCells {
  int width;
  int height;
  std::vector<std::uint8_t> bytes;

  std::uint8_t* row(int y) { return bytes.data() + static_cast<std::ptrdiff_t>(y) * width; }
};

// Replaces every half cell by the maximum over itself and its three neighbours at `step` half cells along +x
// and +y.
void widen(HalfCells& half, int step) {
  for (int y = 0; y < half.height; ++y) {
    std::uint8_t* row = half.row(y);
    for (int x = 0; x + step < half.width; ++x) row[x] = std::max(row[x], row[x + step]);
  }
  for (int y = 0; y + step < half.height; ++y) {
    std::uint8_t* row = half.row(y);
    const std::uint8_t* next = half.row(y + step);
    for (int x = 0; x < half.width; ++x) row[x] = std::max(row[x], next[x]);
  }
}

// Writes the maxima of four rows. The result must not overlap them, so that the compiler vectorises the loop.
void unite(const std::uint8_t* a, const std::uint8_t* b, const std::uint8_t* c, const std::uint8_t* d,
           std::ptrdiff_t size, std::uint8_t* __restrict maxima) {
  for (std::ptrdiff_t x = 0; x < size; ++x) maxima[x] = std::max(std::max(a[x], b[x]), std::max(c[x], d[x]));
}

// Places in a plane, along one axis.
struct Places {
  int first;
  int end;
};

// Returns the places of the half cells of [first, end) that belong to a plane. `first` is not negative.
Places places_in(int plane, int phases, int first, int end) {
  return {(first - plane + phases - 1) / phases, (end - plane + phases - 1) / phases};
}

}  // namespace

BoundTables::BoundTables(int stride_cells, Cell first, Cell end, int columns, int rows)
    : stride_(stride_cells),
      tables_(stride_cells / 2 + 2),
      first_(first),
      end_{first.x + (end.x - first.x + 1) / 2 * 2, first.y + (end.y - first.y + 1) / 2 * 2},
      margin_(stride_cells),
      origin_{first.x - 2 * margin_, first.y - 2 * margin_},
      half_columns_((end.x - first.x + 1) / 2 + margin_),
      half_rows_((end.y - first.y + 1) / 2 + margin_) {
  const int phases = stride_cells / 2;
  layout_.phases = phases;
  while ((1 << layout_.log_phases) < phases) ++layout_.log_phases;
  layout_.columns = columns;
  layout_.rows = rows;
  layout_.plane_columns = (half_columns_ + phases - 1) / phases;
  layout_.plane_rows = (half_rows_ + phases - 1) / phases;
  // The zeros before a row also end the row before, and those before a plane end the plane before.
  const std::int64_t row_bytes = columns + layout_.plane_columns;
  const std::int64_t plane_bytes = row_bytes * (rows + layout_.plane_rows);
  const std::int64_t table_bytes = plane_bytes * phases * phases;
  const std::int64_t size =
      table_bytes * tables_ + row_bytes * (rows + 1) + columns + ScoreLevel::kRunPadding;
  if (size > std::numeric_limits<std::int32_t>::max())
    throw std::invalid_argument("no bounds for a window of " + std::to_string(columns * stride_) + " x " +
                                std::to_string(rows * stride_) + " cells: expected tables of at most 2 GB");
  layout_.row_bytes = static_cast<std::uint32_t>(row_bytes);
  layout_.plane_bytes = static_cast<std::uint32_t>(plane_bytes);
  layout_.table_bytes = static_cast<std::uint32_t>(table_bytes);
  bytes_.assign(static_cast<std::size_t>(size), 0);
}

std::uint8_t* BoundTables::row_of(int table, int plane_y, int plane_x, int y) {
  return bytes_.data() + std::ptrdiff_t{table} * layout_.table_bytes +
         std::ptrdiff_t{plane_y * layout_.phases + plane_x} * layout_.plane_bytes +
         std::ptrdiff_t{layout_.rows + y} * layout_.row_bytes + layout_.columns;
}

void BoundTables::update(const ScoreLevel& scores, Cell first, Cell end) {
  first = {std::max(first.x, first_.x), std::max(first.y, first_.y)};
  end = {std::min(end.x, end_.x), std::min(end.y, end_.y)};
  if (first.x >= end.x || first.y >= end.y) return;
  // The half cells that change. A square of k half cells changes if it begins up to k - 1 half cells before.
  const Cell low = {margin_ + (first.x - first_.x) / 2, margin_ + (first.y - first_.y) / 2};
  const Cell high = {margin_ + (end.x - first_.x + 1) / 2, margin_ + (end.y - first_.y + 1) / 2};
  write_smallest_squares(scores, low, high);
  const int phases = layout_.phases;
  for (int table = 1; table < tables_; ++table) {
    const int reach = phases + table - 1;
    const Cell begin = {std::max(0, low.x - reach), std::max(0, low.y - reach)};
    for (int j = 0; j < phases; ++j)
      for (int i = 0; i < phases; ++i) unite_squares(table, i, j, begin, high);
  }
}

// Writes the first table where the half cells [low, high) have changed.
void BoundTables::write_smallest_squares(const ScoreLevel& scores, Cell low, Cell high) {
  const int phases = layout_.phases;
  const Cell from = {std::max(0, low.x - phases + 1), std::max(0, low.y - phases + 1)};
  const Cell to = {std::min(high.x + phases - 1, half_columns_), std::min(high.y + phases - 1, half_rows_)};
  HalfCells half = {to.x - from.x, to.y - from.y, {}};
  half.bytes.assign(static_cast<std::size_t>(half.width) * static_cast<std::size_t>(half.height), 0);
  const int skipped = std::max(0, margin_ - from.x);
  for (int y = std::max(from.y, margin_); y < to.y; ++y) {
    const std::uint8_t* one =
        scores.cell(first_.x + 2 * (from.x + skipped - margin_), first_.y + 2 * (y - margin_));
    const std::uint8_t* other = one + scores.row_bytes();
    std::uint8_t* __restrict row = half.row(y - from.y) + skipped;
    for (int x = 0, width = half.width - skipped; x < width; ++x)
      row[x] = std::max(std::max(one[2 * x], one[2 * x + 1]), std::max(other[2 * x], other[2 * x + 1]));
  }
  for (int side = 1; side < phases; side *= 2) widen(half, side);
  for (int y = from.y; y < high.y; ++y) {
    const std::uint8_t* squares = half.row(y - from.y);
    for (int i = 0; i < phases; ++i) {
      const Places places = places_in(i, phases, from.x, high.x);
      std::uint8_t* row = row_of(0, y % phases, i, y / phases);
      for (int x = places.first; x < places.end; ++x) row[x] = squares[x * phases + i - from.x];
    }
  }
}

// Makes the squares of one plane of a table that begin in [begin, end). A square is the union of four squares
// of the table before, which are one half cell smaller.
void BoundTables::unite_squares(int table, int i, int j, Cell begin, Cell end) {
  const int phases = layout_.phases;
  const int next_j = (j + 1) % phases;
  const int next_i = (i + 1) % phases;
  const int next_row = next_j == 0 ? 1 : 0;
  const int next_column = next_i == 0 ? 1 : 0;
  const Places columns = places_in(i, phases, begin.x, end.x);
  const Places rows = places_in(j, phases, begin.y, end.y);
  for (int y = rows.first; y < rows.end; ++y)
    unite(row_of(table - 1, j, i, y) + columns.first,
          row_of(table - 1, j, next_i, y) + next_column + columns.first,
          row_of(table - 1, next_j, i, y + next_row) + columns.first,
          row_of(table - 1, next_j, next_i, y + next_row) + next_column + columns.first,
          columns.end - columns.first, row_of(table, j, i, y) + columns.first);
}

}  // namespace psi_slam
