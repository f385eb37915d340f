// SPDX-License-Identifier: BSD-3-Clause
#include "psi/psi_benchmark.h"

#include <nlohmann/json.hpp>

#include "command_fixture.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

TEST(PsiBenchmark, a_bound_belongs_to_the_stratum_below_it) {
  EXPECT_EQ(psi_stratum(0), 0U);
  EXPECT_EQ(psi_stratum(1e-9), 1U);
  EXPECT_EQ(psi_stratum(0.5), 1U);
  EXPECT_EQ(psi_stratum(0.51), 2U);
  EXPECT_EQ(psi_stratum(1e9), kPsiStrata.size());
  EXPECT_EQ(psi_stratum_name(0), "0");
  EXPECT_EQ(psi_stratum_name(1), "0 to 0.5");
  EXPECT_EQ(psi_stratum_name(kPsiStrata.size()), "above 20");
}

TEST(PsiBenchmark, searches_of_scans_are_counted_in_their_strata) {
  MeasuredMap map;
  for (const double psi : {0.0, 0.4, 0.4, 30.0}) {
    FrameRecord& frame = map.result.frames.emplace_back();
    frame.searched_loops = true;
    frame.psi = psi;
    frame.loops_tried = 3;
    frame.loops_accepted = psi > 0 ? 2 : 0;
    frame.loop_matching_ms = 10;
    frame.searches[static_cast<std::size_t>(SearchKind::kGenetic)] = 3;
  }
  map.result.frames[2].searched_loops = false;
  map.add_ms = {20, 8, 30, 40};
  LoopRecord loop;
  loop.frame = 3;
  reject(loop, {LoopRejection::Reason::kLowResponse});
  loop.response = 0.5;
  map.result.loops = {loop, loop, loop};
  reject(map.result.loops[1], {LoopRejection::Reason::kNothingFound});
  map.result.loops[2].in_final_search = true;
  const PsiStrata strata = psi_strata(map);
  EXPECT_EQ(strata[0].scans, 1U);
  EXPECT_EQ(strata[0].loops, 0U);
  EXPECT_EQ(strata[1].scans, 1U);
  EXPECT_EQ(strata[1].windows, 3U);
  EXPECT_EQ(strata[1].loops, 2U);
  EXPECT_EQ(strata[1].scan_ms, std::vector<double>{8}) << "the whole scan took less processor time";
  EXPECT_EQ(strata.back().found, 1U) << "a rejected match was found, too";
  EXPECT_EQ(strata.back().response_sum, 0.5);
  EXPECT_EQ(strata.back().searches[static_cast<std::size_t>(SearchKind::kGenetic)], 3U);
  PsiStratum sum = strata[0];
  sum += strata[1];
  EXPECT_EQ(sum.scan_ms, (std::vector<double>{10, 8}));
}

class PsiCommand : public BenchCommand {
 protected:
  PsiCommand() : BenchCommand("psi") { write_room(); }

  std::filesystem::path json_ = folder_.path() / "psi.json";
};

TEST_F(PsiCommand, has_a_row_for_each_stratum_and_matcher_and_for_each_run) {
  ASSERT_EQ(run({"--matchers", "csm,adaptive", "--json", json_.string()}), 0) << err_.str();
  const Json json = Json::parse(read_file(json_));
  ASSERT_EQ(json["strata"].size(), 2 * (kPsiStrata.size() + 1));
  EXPECT_EQ(json["strata"][0]["psi"], "0");
  EXPECT_EQ(json["strata"][0]["matcher"], "csm");
  EXPECT_GT(json["strata"][0]["scans"], 0);
  std::size_t loops = 0;
  for (const Json& row : json["strata"]) {
    loops += row["loops"].get<std::size_t>();
    if (row["matcher"] == "csm") {
      EXPECT_EQ(row["search_kinds"]["genetic"], 0);
      EXPECT_EQ(row["search_kinds"]["local"], 0);
    }
  }
  EXPECT_GT(loops, 0U);
  ASSERT_EQ(json["runs"].size(), 2U);
  EXPECT_EQ(json["runs"][1]["matcher"], "adaptive");
  EXPECT_LT(json["runs"][1]["translation_abs_m"]["mean"], 0.1);
  EXPECT_THAT(out_.str(), HasSubstr("| above 20 | adaptive |"));
  EXPECT_THAT(out_.str(), HasSubstr("| room | csm | 0.0"));
}

TEST_F(PsiCommand, wrong_usage_gives_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal({"--matchers", "ga_paper"}), HasSubstr("--matchers"));
}

}  // namespace
}  // namespace psi_slam
