// SPDX-License-Identifier: BSD-3-Clause
#include "session/knowledge_line.h"

#include <gmock/gmock.h>

#include "session/edit_journal.h"
#include "session/map_frame.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

TEST(KnowledgeLine, survives_parsing_bit_for_bit) {
  const std::string text =
      "pose time_s=1700000000.500000 x_m=1 y_m=-2.5 yaw_deg=90 sigma_m=0.02 sigma_deg=1\n"
      "pose time_s=1700000001.000000 from_scan=12 x_m=0.30000000000000004 y_m=40000 sigma_m=2\n"
      "tag name=A x_m=4 y_m=5 yaw_deg=-30.5 sigma_m=0.02 sigma_deg=0.5\n"
      "seen name=A time_s=12.000000 ahead_m=1.5 left_m=-0.2 sigma_m=0.03\n";
  const EditJournal journal = EditJournal::parse("# known\n" + text, "my.edits");
  EXPECT_FALSE(journal.empty());
  EXPECT_EQ(knowledge_lines(journal.knowledge()), text);
  EXPECT_EQ(EditJournal::parse(journal.text(), "").text(), journal.text());
  EXPECT_EQ(journal.knowledge().poses[1].source, "my.edits:3");
  EXPECT_EQ(journal.knowledge().poses[0].time_us, 1700000000500000);
  EXPECT_FALSE(journal.knowledge().poses[1].site_T_robot.sigma_rad);
}

TEST(KnowledgeLine, mistakes_get_one_sentence_with_file_and_line) {
  const auto complaint = [](const std::string& line) {
    return sentence_of([&] { EditJournal::parse('\n' + line + '\n', "my.edits"); });
  };
  EXPECT_THAT(complaint("pose time_s=1 x_m=1 y_m=2"), HasSubstr("my.edits:2: \"sigma_m\" is missing"));
  EXPECT_THAT(complaint("pose time_s=soon x_m=1 y_m=2 sigma_m=1"),
              HasSubstr("my.edits:2: time_s=soon: expected seconds, as trajectory.csv lists them"));
  EXPECT_THAT(complaint("pose time_s=1 x_m=1 y_m=2 sigma_m=0"),
              HasSubstr("my.edits:2: sigma_m=0: expected a number of metres from 0.000001 to 1000. State"));
  for (const char* line :
       {"pose time_s=1 x_m=1 y_m=2 sigma_m=1e-100", "pose time_s=1 x_m=1 y_m=2 sigma_m=1001",
        "tag name=A x_m=1 y_m=2 sigma_m=1e-7", "seen name=A time_s=1 ahead_m=1 left_m=0 sigma_m=1e-300"})
    EXPECT_THAT(complaint(line), HasSubstr("expected a number of metres from 0.000001 to 1000"));
  EXPECT_THAT(complaint("pose time_s=1 x_m=1 y_m=2 yaw_deg=3 sigma_deg=1e-200 sigma_m=1"),
              HasSubstr("my.edits:2: sigma_deg=1e-200: expected a number of degrees from 0.000001 to 180"));
  EXPECT_THAT(complaint("pose time_s=1 x_m=1e9 y_m=2 sigma_m=1"), HasSubstr("x_m=1e9: expected"));
  EXPECT_THAT(complaint("pose time_s=1 x_m=1 y_m=2 yaw_deg=3 sigma_m=1"),
              HasSubstr("expected both yaw_deg and its standard deviation sigma_deg"));
  EXPECT_THAT(complaint("tag name=A x_m=1 y_m=2 yaw_deg=3 sigma_deg=181 sigma_m=1"),
              HasSubstr("degrees from 0.000001 to 180"));
  EXPECT_THAT(complaint("seen name=A time_s=1 x_m=2 left_m=1 sigma_m=1"), HasSubstr("unknown key \"x_m\""));
  EXPECT_THAT(complaint("psoe time_s=1"), HasSubstr("did you mean \"pose\"?"));
  EXPECT_THAT(complaint("tag name=A x_m=1 y_m=2 sigma_m=1\ntag name=A x_m=1 y_m=3 sigma_m=1"),
              HasSubstr("tag A has two places, at my.edits:2 and at my.edits:3"));
}

TEST(KnowledgeLine, a_later_run_searches_its_times_among_its_scans) {
  const EditJournal journal = EditJournal::parse(
      "pose time_s=1 x_m=1 y_m=2 sigma_m=1\nseen name=A time_s=1 from_scan=3 ahead_m=1 left_m=0 sigma_m=1\n",
      "");
  const EditJournal later = journal.of_run(100, 50, 4);
  EXPECT_EQ(later.knowledge().poses.at(0).from_scan, 100U);
  EXPECT_EQ(later.knowledge().sightings.at(0).from_scan, 103U);
}

TEST(KnowledgeLine, only_one_of_settings_and_knowledge_states_the_frame) {
  const FixedKnowledge known = EditJournal::parse("pose time_s=1 x_m=1 y_m=2 sigma_m=1\n", "").knowledge();
  check_frame({}, known);
  check_frame({"walls"}, {});
  EXPECT_THAT(sentence_of([&] { check_frame({"walls"}, known); }),
              HasSubstr("Remove these settings, or the lines"));
}

}  // namespace
}  // namespace psi_slam
