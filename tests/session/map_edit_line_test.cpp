// SPDX-License-Identifier: BSD-3-Clause
#include "session/map_edit_line.h"

#include <gmock/gmock.h>

#include "session/edit_journal.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

TEST(MapEditLine, survives_parsing_bit_for_bit) {
  for (const char* line :
       {"erase polygon=1,2;3.5,-2;3,4.125", "unknown polygon=0,0;1,0;1,1;0,1",
        "wall line=0,0;4,0.30000000000000004 width_m=0.1", "wall line=0,0;4,0",
        "crop polygon=-10,-10;30,-10;30,20", "keep_out polygon=7,1;9,1;9,3",
        "slow polygon=7,1;9,1;9,3 percent=40", "slow polygon=7,1;9,1;9,3 max_speed_mps=0.3",
        "wall line=0,0;4,0 width_m=0.1 frame=1.5,-2,90",
        "erase polygon=1,2;3.5,-2;3,4 frame=0,0,12.3 scan=40"}) {
    const auto edit = parse_map_edit_line(line);
    ASSERT_TRUE(edit) << line;
    EXPECT_EQ(map_edit_line(*edit), line);
  }
  EXPECT_FALSE(parse_map_edit_line("delete scan=1 local_map=2"));
}

TEST(MapEditLine, mistakes_get_one_sentence) {
  const auto complaint = [](const char* line) { return sentence_of([&] { parse_map_edit_line(line); }); };
  EXPECT_THAT(complaint("erase polygon=1,2;3,4"), HasSubstr("expected at least 3 points X,Y in metres"));
  EXPECT_THAT(complaint("erase polygon=1,2;3,4;5"), HasSubstr("polygon=1,2;3,4;5: expected"));
  EXPECT_THAT(complaint("erase polygon=1,2;3,4;5,nan"), HasSubstr("expected at least 3 points"));
  EXPECT_THAT(complaint("erase polygon=1,2;3,4;5,1e9"), HasSubstr("expected at least 3 points"));
  EXPECT_THAT(complaint("wall polygon=1,2;3,4"),
              HasSubstr("unknown key \"polygon\": expected line, width_m"));
  EXPECT_THAT(complaint("wall line=1,2;3,4 width_m=0"), HasSubstr("above 0 and at most 100"));
  EXPECT_THAT(complaint("wall line=1,2;3,4 frame=1,2"),
              HasSubstr("frame=1,2: expected the pose of the robot"));
  EXPECT_THAT(complaint("wall line=1,2;3,4 frame=1,2,x"), HasSubstr("X,Y,YAW in metres and degrees"));
  EXPECT_THAT(complaint("wall line=1,2;3,4 scan=7"), HasSubstr("scan=7: expected also frame=X,Y,YAW"));
  EXPECT_THAT(complaint("crop"), HasSubstr("\"polygon\" is missing"));
  EXPECT_THAT(complaint("slow polygon=7,1;9,1;9,3"), HasSubstr("either percent or max_speed_mps"));
  for (const char* line : {"slow polygon=7,1;9,1;9,3 percent=100", "slow polygon=7,1;9,1;9,3 percent=0.5"})
    EXPECT_THAT(complaint(line), HasSubstr("expected a number from 1 to 99")) << line;
}

TEST(MapEditLine, the_journal_keeps_edits_of_loops_and_of_the_map) {
  const std::string text =
      "wall line=0,0;4,0\ndelete scan=812 local_map=14 after=1500\nerase polygon=1,2;3,4;5,6\n";
  const EditJournal journal = EditJournal::parse(text, "my.edits");
  EXPECT_EQ(journal.edits().size(), 1U);
  ASSERT_EQ(journal.map_edits().size(), 2U);
  EXPECT_EQ(journal.map_edits()[0].kind, MapEdit::Kind::kWall) << "in the order of the lines";
  EXPECT_EQ(EditJournal::parse(journal.text(), "").text(), journal.text());
  EditJournal more;
  EXPECT_TRUE(more.empty());
  more.add(journal);
  EXPECT_EQ(more.text(), journal.text());
  EXPECT_EQ(journal.of_run(0, 2000, 0).map_edits().size(), 2U);
  EXPECT_EQ(journal.of_run(5, 2000, 1).map_edits().size(), 0U) << "the frame of a later run is unknown";
  const auto later = journal.with_frames({1, 2, 0}).of_run(5, 2000, 1).map_edits();
  ASSERT_EQ(later.size(), 2U);
  EXPECT_EQ(map_edit_line(later[0]), "wall line=0,0;4,0 frame=1,2,0 scan=5");
  const EditJournal crop = EditJournal::parse("crop polygon=0,0;4,0;4,4 frame=0,0,0\n", "my.edits");
  EXPECT_EQ(crop.of_run(0, 2000, 0).map_edits().size(), 1U);
  EXPECT_EQ(crop.of_run(5, 2000, 1).map_edits().size(), 0U) << "it would cut off the other runs";
  EXPECT_THAT(sentence_of([] { EditJournal::parse("\nwal line=0,0;4,0\n", "my.edits"); }),
              HasSubstr("my.edits:2: unknown edit \"wal\""));
}

TEST(MapEditLine, a_file_limits_the_speed_in_one_way) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "my.edits";
  write_file(file, "slow polygon=0,0;1,0;1,1 percent=40\nslow polygon=0,0;1,0;1,1 max_speed_mps=1\n");
  EXPECT_THAT(sentence_of([&] { EditJournal::read(file); }),
              HasSubstr("my.edits: the edits limit the speed"));
  EXPECT_THAT(sentence_of([&] { EditJournal::parse(read_file(file), "my.session"); }),
              HasSubstr("my.session: the edits limit the speed"));
}

}  // namespace
}  // namespace psi_slam
