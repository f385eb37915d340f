// SPDX-License-Identifier: BSD-3-Clause
#include "closing_text.h"

#include <gmock/gmock.h>

#include "doubtful_map.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;

class ClosingText : public testing::Test {
 protected:
  std::string text() const {
    return closing_text(summary_, "my.log", OutputFolder::prepare(folder_.path() / "out", true));
  }

  TemporaryFolder folder_;
  RunSummary summary_;
};

TEST_F(ClosingText, names_the_map_and_its_figures) {
  summary_.log.scans = 13631;
  summary_.log.duration_s = 2691;
  summary_.path_length_m = 503.4;
  summary_.nodes = 3463;
  summary_.loops.accepted = 1;
  summary_.wall_s = 20.25;
  summary_.real_time_factor = 132.9;
  summary_.peak_memory_mib = 305;
  const std::string folder = (folder_.path() / "out").string();
  std::filesystem::create_directory(folder);
  write_file(folder + "/map.png", "a picture");
  EXPECT_EQ(text(), "The map is in " + folder + "/map.png, the report in " + folder +
                        "/report.html.\n"
                        "13631 scans of my.log over 44:51 and 503 m: 3463 nodes, 1 loop closed.\n"
                        "It took 20.2 s, real-time factor 132.9, and 305 MiB of memory.\n");
}

TEST_F(ClosingText, names_the_folder_without_map_png) {
  const std::string folder = (folder_.path() / "out").string();
  EXPECT_THAT(text(), HasSubstr("The map is in " + folder + ", the report in " + folder + "/report.html.\n"));
}

TEST_F(ClosingText, leaves_out_an_unknown_real_time_factor) {
  EXPECT_THAT(text(), Not(HasSubstr("factor")));
}

TEST_F(ClosingText, ends_with_the_verdict_about_a_good_map) {
  EXPECT_THAT(text(), Not(HasSubstr("Verdict")));
  summary_.verdict = MapVerdict();
  EXPECT_THAT(text(), HasSubstr("Verdict: the map is unchecked: "));
  summary_.verdict->state = MapState::kGood;
  summary_.verdict->checked_share = 0.5;
  EXPECT_THAT(text(), HasSubstr("Verdict: the map is good: "));
  EXPECT_FALSE(broken_map_text(summary_));
}

TEST_F(ClosingText, names_the_worst_place_of_a_doubtful_map_and_warns_of_a_broken_one) {
  EXPECT_FALSE(broken_map_text(summary_)) << "not judged";
  summary_.verdict = doubtful_map();
  constexpr const char* kAdvice = ". Try: make the edit \"delete scan=45 local_map=3\"";
  EXPECT_THAT(text(), HasSubstr(kAdvice));
  EXPECT_FALSE(broken_map_text(summary_));
  summary_.verdict->state = MapState::kBroken;
  EXPECT_THAT(text(), Not(HasSubstr("Verdict")));
  EXPECT_THAT(broken_map_text(summary_).value_or(""), testing::EndsWith(kAdvice));
}

TEST_F(ClosingText, lists_the_stages) {
  MappingResult result;
  result.stages = {{"read log", 10, 1.5, 0.5, 1, 2, 0.015}, {"draw map", 1, 60, 0, 60, 60, 0.06}};
  EXPECT_THAT(stages_text(result),
              testing::MatchesRegex("read log +10 x +1.500 ± 0.500 ms  \\[1.000, 2.000\\] +0.0[12] s\n"
                                    "draw map +1 x +60.000 ± 0.000 ms  \\[60.000, 60.000\\] +0.06 s\n"));
}

}  // namespace
}  // namespace psi_slam
