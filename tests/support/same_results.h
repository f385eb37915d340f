// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <sstream>

#include "test_files.h"

namespace psi_slam {

/// Rows without their last column, which tells a time.
inline std::string without_last_column(const std::string& csv) {
  std::istringstream rows(csv);
  std::string text;
  for (std::string row; std::getline(rows, row);) text += row.substr(0, row.rfind(',')) + '\n';
  return text;
}

/// The result folders of two runs hold the same bytes; but for the files that tell times.
inline void expect_same_results(const std::filesystem::path& a, const std::filesystem::path& b) {
  for (const char* name : {"trajectory.tum", "trajectory.carmen", "graph.g2o", "map.pgm", "map.yaml",
                           "map.png", "map.gridmap.gz", "map.simplemap.gz"}) {
    const std::string bytes = read_file(a / name);
    EXPECT_FALSE(bytes.empty()) << name;
    EXPECT_TRUE(read_file(b / name) == bytes) << name << " of " << b << " differs from " << a;
  }
  EXPECT_EQ(without_last_column(read_file(a / "loops.csv")), without_last_column(read_file(b / "loops.csv")));
}

}  // namespace psi_slam
