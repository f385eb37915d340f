// SPDX-License-Identifier: BSD-3-Clause
#include "exports/summary_json.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "simulated_room.h"

namespace psi_slam {
namespace {

RunSummary some_figures() {
  RunSummary summary;
  summary.log.scans = 50;
  summary.log.first_time_us = 976052905167303;
  summary.log.duration_s = 9.8;
  summary.loops.accepted = 1;
  summary.loops.reasons = {{LoopRefusal::Reason::kLowResponse, 7}};
  summary.real_time_factor = 19.6;
  summary.peak_memory_mib = 123.4;
  summary.final_search_cut_short = true;
  summary.broken_off = "room.clf:41: expected a number";
  summary.log.companion_scans = 48;
  summary.log.spare_scans = 2;
  return summary;
}

TEST(SummaryJson, reads_back_with_its_schema_and_figures) {
  const MappingResult result = walk_around_the_room();
  const RunInfo info{"0.1.0", "room \"1\".clf", {{"front_end.window_x_m", "0.3"}}, {"a line is odd"}};
  const auto json = nlohmann::json::parse(summary_json(result, info, some_figures()));
  EXPECT_EQ(json["schema"], "psi-slam-summary");
  EXPECT_EQ(json["schema_version"], kSummarySchemaVersion);
  EXPECT_EQ(json["warnings"], nlohmann::json::array({"a line is odd"}));
  EXPECT_EQ(json["program_version"], "0.1.0");
  EXPECT_EQ(json["log"]["name"], "room \"1\".clf");
  EXPECT_EQ(json["log"]["scans"], 50);
  EXPECT_EQ(json["log"]["first_time_s"], "976052905.167303");
  EXPECT_EQ(json["log"]["companion_scans"], 48);
  EXPECT_EQ(json["log"]["spare_scans"], 2);
  EXPECT_EQ(json["real_time_factor"], 19.6);
  EXPECT_EQ(json["last_pass_cut_short"], true);
  EXPECT_EQ(json["broken_off"], "room.clf:41: expected a number");
  EXPECT_EQ(json["settings"]["front_end.window_x_m"], "0.3");
  EXPECT_EQ(json["loop_counts"]["reasons"][0]["count"], 7);
  EXPECT_EQ(json["loop_counts"]["reasons"][0]["reason"], "the response is too low");
  ASSERT_EQ(json["loop_matchers"].size(), 1U);
  const auto& matcher = json["loop_matchers"][0];
  EXPECT_EQ(matcher["matcher"], "csm");
  EXPECT_EQ(matcher["attempts"], 12);
  EXPECT_EQ(matcher["found"], 2);
  EXPECT_EQ(matcher["accepted"], 1);
  EXPECT_EQ(matcher["evaluations"], 600);
  EXPECT_EQ(matcher["milliseconds"], 45.25);
  EXPECT_EQ(matcher["last_pass"]["attempts"], 2);
  EXPECT_EQ(matcher["last_pass"]["accepted"], 0);
  EXPECT_EQ(json["stages"][0]["calls"], 50);
}

TEST(SummaryJson, survives_what_is_not_a_number_and_not_utf8) {
  RunSummary summary = some_figures();
  summary.mean_response = std::numeric_limits<double>::quiet_NaN();
  const auto json = nlohmann::json::parse(summary_json({}, {"0.1.0", "caf\xe9.clf", {}}, summary));
  EXPECT_TRUE(json["mean_response"].is_null());
  EXPECT_TRUE(json["settings"].is_object());
  EXPECT_TRUE(nlohmann::json::parse(summary_json({}, {}, {}))["broken_off"].is_null());
}

}  // namespace
}  // namespace psi_slam
