// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/nearest_name.h"

#include <algorithm>
#include <array>

namespace psi_slam {
namespace {

char lower(char c) {
  return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
}

}  // namespace

std::size_t edit_distance(std::string_view a, std::string_view b) {
  // Row i of a table and the two rows above it. Entry j of row i is the distance between the first i letters
  // of `a` and the first j letters of `b`.
  std::array<std::vector<std::size_t>, 3> rows;
  for (auto& row : rows) row.resize(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) rows[0][j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    auto& row = rows[i % 3];
    const auto& above = rows[(i + 2) % 3];
    const auto& two_above = rows[(i + 1) % 3];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const bool same = lower(a[i - 1]) == lower(b[j - 1]);
      row[j] = std::min({above[j] + 1, row[j - 1] + 1, above[j - 1] + (same ? 0 : 1)});
      if (i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) && lower(a[i - 2]) == lower(b[j - 1]))
        row[j] = std::min(row[j], two_above[j - 2] + 1);
    }
  }
  return rows[a.size() % 3][b.size()];
}

std::optional<std::string> nearest_name(std::string_view misspelt, const std::vector<std::string>& names) {
  std::optional<std::string> nearest;
  std::size_t limit = 1 + misspelt.size() / 4;
  for (const std::string& name : names) {
    const auto [shorter, longer] = std::minmax({misspelt.size(), name.size()});
    if (longer - shorter > limit) continue;  // at least this many letters differ
    const std::size_t distance = edit_distance(misspelt, name);
    if (distance > limit || (nearest && distance == limit)) continue;
    nearest = name;
    limit = distance;
  }
  return nearest;
}

}  // namespace psi_slam
