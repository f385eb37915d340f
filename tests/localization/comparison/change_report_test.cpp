// SPDX-License-Identifier: BSD-3-Clause
#include "localization/comparison/change_report.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

namespace psi_slam {
namespace {

using testing::HasSubstr;

MapComparison sample() {
  MapComparison comparison;
  comparison.alignment.method = MapAlignment::Method::kWholeMap;
  comparison.alignment.a_T_b = {1, -2, M_PI / 2};
  comparison.alignment.covariance.diagonal() << 0.0004, 0.0001, 1e-6;
  WallChange gone;
  gone.kind = WallChange::Kind::kVanished;
  gone.from = {1, 2};
  gone.to = {4, 6};
  gone.length_m = 5;
  WallChange moved = gone;
  moved.kind = WallChange::Kind::kMoved;
  moved.shift = {0.3, -0.4};
  comparison.walls.changes = {gone, moved};
  comparison.walls.compared_m2 = 123.4;
  return comparison;
}

TEST(ChangeReport, the_sentence_has_numbers_and_lengths_of_each_kind) {
  const std::string text = comparison_text(sample());
  EXPECT_THAT(text,
              HasSubstr("2 walls changed in the 123 m² that both maps show: 1 vanished (5.0 m), 1 moved "
                        "(5.0 m).\n"));
  EXPECT_THAT(text,
              HasSubstr("at x 1.000 m, y -2.000 m, yaw 90.00 degrees, with standard deviations of 0.020 "
                        "m and 0.057 degrees"));
  EXPECT_THAT(comparison_text({}), HasSubstr("No wall has changed"));
}

TEST(ChangeReport, json_has_alignment_limits_and_counts) {
  const auto json = nlohmann::json::parse(comparison_json(sample()));
  EXPECT_EQ(json["changed"], true);
  EXPECT_EQ(json["alignment"]["method"], "whole_map");
  EXPECT_NEAR(json["alignment"]["sigma_x_m"].get<double>(), 0.02, 1e-9);
  EXPECT_EQ(json["appeared"]["walls"], 0);
  EXPECT_EQ(json["moved"]["length_m"], 5);
  EXPECT_EQ(nlohmann::json::parse(comparison_json({}))["changed"], false);
}

TEST(ChangeReport, the_table_has_one_row_per_change) {
  EXPECT_EQ(changes_csv(sample().walls.changes),
            "kind,x_m,y_m,from_x_m,from_y_m,to_x_m,to_y_m,length_m,shift_m,shift_x_m,shift_y_m\n"
            "vanished,2.500,4.000,1.000,2.000,4.000,6.000,5.000,,,\n"
            "moved,2.500,4.000,1.000,2.000,4.000,6.000,5.000,0.500,0.300,-0.400\n");
}

}  // namespace
}  // namespace psi_slam
