// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_comparison.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace psi_slam {
namespace {

const PublishedSystem& system_of(const std::string& name) {
  for (const PublishedSystem& system : published_systems())
    if (system.name == name) return system;
  throw std::invalid_argument("no system " + name);
}

TEST(PublishedFigures, each_row_has_a_known_log_a_mean_and_a_source) {
  for (const PublishedSystem& system : published_systems()) {
    EXPECT_NE(system.source, "");
    EXPECT_FALSE(system.logs.empty()) << system.name;
    for (const PublishedLog& log : system.logs) {
      SCOPED_TRACE(system.name + ", " + log.log);
      EXPECT_TRUE(std::any_of(benchmark_log_titles().begin(), benchmark_log_titles().end(),
                              [&](const BenchmarkLogTitle& title) { return title.log == log.log; }));
      ASSERT_TRUE(log.errors[0]);
      EXPECT_TRUE(log.errors[0]->std || system.name == "Cartographer (its paths)");
      for (const auto& figure : log.errors) EXPECT_GT(figure.value_or(*log.errors[0]).mean, 0);
    }
  }
}

TEST(PublishedFigures, the_paper_has_all_four_errors_of_each_log) {
  EXPECT_EQ(system_of("GA-based (paper)").logs.size(), benchmark_log_titles().size());
  std::size_t baselines = 0;
  for (const char* name : {"GA-based (paper)", "Karto (paper)", "GMapping (paper)"}) {
    for (const PublishedLog& log : system_of(name).logs) {
      SCOPED_TRACE(std::string(name) + ", " + log.log);
      baselines += std::string(name) == "GA-based (paper)" ? 0 : 1;
      for (const auto& figure : log.errors) {
        ASSERT_TRUE(figure);
        EXPECT_TRUE(figure->std);
      }
      // A mean of squares is at least the squared mean, except for rounding.
      EXPECT_GT(log.errors[1]->mean, log.errors[0]->mean * log.errors[0]->mean);
      EXPECT_GT(log.errors[3]->mean, log.errors[2]->mean * log.errors[2]->mean - 0.001);
    }
  }
  EXPECT_EQ(baselines, benchmark_log_titles().size()) << "each log has one of the paper's two baselines";
}

TEST(PublishedFigures, cartographer_and_graph_mapping_have_all_four_errors_of_each_log) {
  for (const char* name : {"Cartographer", "graph mapping"}) {
    ASSERT_EQ(system_of(name).logs.size(), benchmark_log_titles().size()) << name;
    for (const PublishedLog& log : system_of(name).logs) {
      SCOPED_TRACE(std::string(name) + ", " + log.log);
      for (const std::size_t absolute : {0U, 2U}) {
        const PublishedFigure& figure = log.errors[absolute].value();
        const double mean_square = figure.mean * figure.mean + *figure.std * *figure.std;
        // Figures of graph mapping are rounded to one digit; for MIT Killian they differ most.
        EXPECT_GT(log.errors[absolute + 1].value().mean, 0.8 * mean_square);
        EXPECT_LT(log.errors[absolute + 1].value().mean, 1.9 * mean_square);
      }
    }
  }
}

TEST(PublishedFigures, the_hospital_has_two_names) {
  EXPECT_EQ(benchmark_log_name("hospital"), "fr-hospital");
  EXPECT_EQ(benchmark_log_title("hospital"), "Freiburg hospital");
  EXPECT_EQ(benchmark_log_title("intel"), "Intel");
  EXPECT_EQ(benchmark_log_title("my room"), "my room");
}

}  // namespace
}  // namespace psi_slam
