// SPDX-License-Identifier: BSD-3-Clause
#include "batch/report_table.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using Json = nlohmann::ordered_json;

struct Row {
  std::string name;
  std::vector<double> errors_m;
  std::optional<double> recall;
};

ReportTable table() {
  const std::vector<ColumnOf<Row>> columns{
      {{"log", "log", true}, [](const Row& row) { return cell(row.name); }},
      {{"error [m]", "error_m"}, [](const Row& row) { return cell(spread_of(row.errors_m), 2); }},
      {{"recall %", "loops.recall"}, [](const Row& row) { return cell(row.recall, 1, 100); }},
      {{"", "seeds"},
       [](const Row& row) {
         return ReportCell{{}, Json(row.errors_m)};
       }},
      {{"remark"}, [](const Row&) { return cell(std::string("a|b")); }}};
  return table_of(columns, std::vector<Row>{{"one", {1, 3}, 0.5}, {"a, b", {}, {}}});
}

TEST(ReportTable, markdown_has_the_columns_with_a_head) {
  EXPECT_EQ(table().markdown(),
            "| log | error [m] | recall % | remark |\n|---|---:|---:|---:|\n"
            "| one | 2.00 ± 1.41 [3.00] | 50.0 | a/b |\n| a, b | – | – | a/b |\n");
}

TEST(ReportTable, html_has_the_texts_of_markdown) {
  ReportTable marked = table();
  marked.rows[0][1].best = true;
  EXPECT_NE(marked.html().find("<tr><td class=\"word\">one</td><td class=\"best\">2.00"), std::string::npos);
}

TEST(ReportTable, json_has_the_columns_with_a_key) {
  const Json json = table().json();
  ASSERT_EQ(json.size(), 2U);
  EXPECT_EQ(json[0]["error_m"]["max"], 3.0);
  EXPECT_EQ(json[0]["loops"]["recall"], 0.5);
  EXPECT_EQ(json[0]["seeds"], Json({1.0, 3.0}));
  EXPECT_EQ(json[0].size(), 4U);
  EXPECT_TRUE(json[1]["loops"]["recall"].is_null());
}

TEST(ReportTable, a_cell_without_data_is_missing_in_json) {
  ReportTable missing = table();
  missing.rows[0][1] = empty_cell();
  EXPECT_FALSE(missing.json()[0].contains("error_m"));
  EXPECT_NE(missing.markdown().find("| one | – | 50.0 |"), std::string::npos);
}

TEST(ReportTable, csv_has_a_column_for_each_member) {
  EXPECT_EQ(table().csv(),
            "log,error_m.mean,error_m.std,error_m.min,error_m.max,loops.recall,seeds\n"
            "one,2.0,1.4142135623730951,1.0,3.0,0.5,1.0 3.0\n\"a, b\",,,,,,\n");
}

}  // namespace
}  // namespace psi_slam
