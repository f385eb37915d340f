// SPDX-License-Identifier: BSD-3-Clause
#include "session/edit_journal.h"

#include <gmock/gmock.h>

#include <cmath>
#include <fstream>

#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;
using Kind = LoopEdit::Kind;

EditTime after(std::size_t scan) {
  return {EditTime::Kind::kAfterScan, scan};
}

const EditTime kEnd{EditTime::Kind::kEnd, 0};

class EditJournalTest : public testing::Test {
 protected:
  std::filesystem::path file(const std::string& text) const {
    std::ofstream(path_) << text;
    return path_;
  }

  std::string complaint(const std::string& text) const {
    try {
      EditJournal::read(file(text));
    } catch (const UserError& error) {
      return error.what();
    }
    return "";
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "my.edits";
};

TEST_F(EditJournalTest, survives_its_file_to_the_last_bit) {
  EditJournal journal;
  journal.add({{Kind::kDelete, 812, 14}, after(1500)});
  LoopEdit match{Kind::kMatch, 900, 3};
  match.matcher = MatcherKind::kCsmGa;
  match.place = LoopPlace{{1.0 / 3, -2e-9, M_PI / 7}, {2.1, 2.1, 0.1}};
  journal.add({match, kEnd});
  LoopEdit force{Kind::kForce, 1, 2};
  force.of_final_search = true;
  journal.add({force, {}});
  journal.add({{Kind::kRestore, 812, 14}, after(1600)});
  journal.write(path_);
  const EditJournal back = EditJournal::read(path_);
  EXPECT_EQ(back.text(), journal.text());
  ASSERT_THAT(back.edits(), SizeIs(4));
  EXPECT_TRUE(back.edits()[0].edit.of_final_search);
  EXPECT_THAT(complaint("force scan=1 local_map=2 attempt=first"),
              HasSubstr("attempt=first: expected final_search"));
  EXPECT_TRUE(
      EditJournal::parse("force scan=1 local_map=2 attempt=last_pass", "").edits().at(0).edit.of_final_search)
      << "last_pass is the old name of final_search";
  const LoopEdit& read = back.edits()[3].edit;
  EXPECT_EQ(read.kind, Kind::kMatch);
  EXPECT_EQ(read.matcher, MatcherKind::kCsmGa);
  ASSERT_TRUE(read.place.has_value());
  EXPECT_EQ(read.place->anchor_T_node, match.place->anchor_T_node);
  EXPECT_EQ(read.place->window.theta_rad, match.place->window.theta_rad);
}

TEST_F(EditJournalTest, reads_hand_written_lines) {
  const EditJournal journal =
      EditJournal::read(file("# false: two equal doors\n\n  delete   local_map=3 scan=40   # here\nmatch "
                             "scan=5 local_map=1 matcher=ga\n"));
  ASSERT_THAT(journal.edits(), SizeIs(2));
  EXPECT_EQ(journal.edits()[0].edit.frame, 40U);
  EXPECT_EQ(journal.edits()[0].time.kind, EditTime::Kind::kBegin);
  EXPECT_FALSE(journal.edits()[1].edit.place.has_value());
}

TEST_F(EditJournalTest, takes_each_edit_once_in_the_order_of_time) {
  EditJournal journal;
  journal.add({{Kind::kDelete, 3, 0}, kEnd});
  journal.add({{Kind::kDelete, 2, 0}, after(7)});
  journal.add({{Kind::kForce, 2, 0}, after(7)});
  journal.add({{Kind::kDelete, 1, 0}, {}});
  EXPECT_THAT(journal.take_due({}), SizeIs(1));
  EXPECT_THAT(journal.take_due(after(6)), IsEmpty());
  const std::vector<LoopEdit> due = journal.take_due(after(7));
  ASSERT_THAT(due, SizeIs(2));
  EXPECT_EQ(due[0].kind, Kind::kDelete) << "edits of the same time keep their order";
  EXPECT_THAT(journal.take_due(after(1000000)), IsEmpty()) << "the end is later than any scan";
  EXPECT_THAT(journal.take_due(kEnd), SizeIs(1));
  journal.rewind();
  EXPECT_THAT(journal.take_due(kEnd), SizeIs(4));
}

TEST_F(EditJournalTest, the_edit_in_force_is_the_last_one_taken) {
  EditJournal journal;
  journal.add({{Kind::kDelete, 2, 0}, {}});
  journal.add({{Kind::kForce, 2, 0}, after(7)});
  journal.take_due(after(3));
  const LoopEdit same{Kind::kRestore, 2, 0};
  EXPECT_EQ(journal.in_force(same)->kind, Kind::kDelete) << "the other edit is still to come";
  EXPECT_FALSE(journal.in_force({Kind::kRestore, 2, 1}).has_value());
  journal.take_due(after(7));
  EXPECT_EQ(journal.in_force(same)->kind, Kind::kForce);
}

TEST_F(EditJournalTest, a_new_edit_replaces_later_edits_of_the_loop) {
  EditJournal journal;
  journal.add({{Kind::kDelete, 2, 0}, after(7)});
  journal.add({{Kind::kForce, 2, 1}, after(9)});
  journal.take_due(after(3));
  journal.enter({{Kind::kForce, 2, 0}, after(3)});
  EXPECT_EQ(journal.text(),
            "# psi-slam loop edits 1\nforce scan=2 local_map=0 after=3\nforce scan=2 local_map=1 after=9\n");
  EXPECT_FALSE(journal.forget_later({Kind::kRestore, 2, 0})) << "the edit of this loop has been made";
  EXPECT_TRUE(journal.forget_later({Kind::kRestore, 2, 1}));
  EXPECT_THAT(journal.edits(), SizeIs(1));
}

TEST_F(EditJournalTest, invalid_lines_give_errors_with_file_and_line) {
  EXPECT_THAT(complaint("delete scan=1 local_map=2\ndelte scan=1 local_map=2\n"),
              AllOf(HasSubstr("my.edits:2: unknown edit \"delte\""), HasSubstr("did you mean \"delete\"?")));
  EXPECT_THAT(complaint("delete scan=1"), HasSubstr(":1: \"local_map\" is missing"));
  EXPECT_THAT(complaint("delete scan=1.5 local_map=2"), HasSubstr("scan=1.5: expected a whole number"));
  EXPECT_THAT(complaint("delete scan=-1 local_map=2"), HasSubstr(": expected a whole number, 0 or more"));
  EXPECT_THAT(complaint("delete scan=1 local_map=2 matcher=ga"), HasSubstr("unknown key \"matcher\""));
  EXPECT_THAT(complaint("delete scan=1 locl_map=2"), HasSubstr("did you mean \"local_map\"?"));
  EXPECT_THAT(complaint("delete scan=1 scan=1 local_map=2"), HasSubstr("\"scan\" is given twice"));
  EXPECT_THAT(complaint("delete scan 1"), HasSubstr("\"scan\": expected KEY=VALUE"));
  EXPECT_THAT(complaint("match scan=1 local_map=2"), HasSubstr("\"matcher\" is missing"));
  EXPECT_THAT(complaint("match scan=1 local_map=2 matcher=csn"), HasSubstr(": expected csm, csm_ga or ga"));
  EXPECT_THAT(complaint("match scan=1 local_map=2 matcher=ga x_m=1"), HasSubstr("\"y_m\" is missing"));
  EXPECT_THAT(complaint("match scan=1 local_map=2 matcher=ga x_m=1 y_m=2 yaw_deg=0 window_m=0 window_deg=5"),
              HasSubstr("window_m=0: expected a number above 0"));
  EXPECT_THAT(complaint("delete scan=1 local_map=2 after=soon"), HasSubstr("after=soon"));
  EXPECT_THAT(complaint(std::string("delete scan=1\0x local_map=2", 27)),
              HasSubstr("scan=1?x: expected a whole number, 0 or more"));
  EXPECT_THAT(complaint(std::string(1'000'000, 'a')),
              HasSubstr("unknown edit \"" + std::string(80, 'a') + "...\": expected"));
  EXPECT_THROW(EditJournal::read(folder_.path() / "none"), UserError);
}

TEST_F(EditJournalTest, renumbers_the_edits_of_a_later_run) {
  EditJournal journal;
  journal.add({{Kind::kDelete, 8, 1}, {}});
  journal.add({{Kind::kForce, 8, 2}, after(20)});
  journal.add({{Kind::kRestore, 9, 1}, kEnd});
  EXPECT_EQ(journal.of_run(100, 50, 7).text(),
            "# psi-slam loop edits 1\ndelete scan=108 local_map=8 after=99\n"
            "force scan=108 local_map=9 after=120\nrestore scan=109 local_map=8 after=149\n");
  EXPECT_EQ(journal.of_run(0, 50, 0).text(),
            "# psi-slam loop edits 1\ndelete scan=8 local_map=1\nforce scan=8 local_map=2 after=20\n"
            "restore scan=9 local_map=1 after=49\n");
}

TEST_F(EditJournalTest, parses_text_like_a_file) {
  const std::string text = "# mine\ndelete scan=40 local_map=3  # here\n";
  EXPECT_EQ(EditJournal::parse(text, "my.session").text(), EditJournal::read(file(text)).text());
  EXPECT_THAT(sentence_of([] { EditJournal::parse("\ndelete scan=40\n", "my.session"); }),
              testing::HasSubstr("my.session:2: "));
}

}  // namespace
}  // namespace psi_slam
