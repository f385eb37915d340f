// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_journal.h"

#include <gmock/gmock.h>

#include <memory>

#include "full_disk.h"
#include "psi_slam/user_error.h"
#include "session/session_file.h"
#include "small_recording.h"
#include "soon.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
namespace fs = std::filesystem;

class SessionJournalTest : public testing::Test {
 protected:
  SessionJournalTest() {
    facts_.logs = {{"my.log", "", 0}};
    facts_.settings = "[run]\n";
  }

  std::size_t recorded() const { return read_session_file(path_).frames.size(); }

  void add(SessionJournal& journal, const Frame& frame) {
    ++facts_.logs[0].scans;
    journal.add(frame, facts_);
  }

  const std::vector<Frame> frames_ = small_recording().frames;
  SessionFacts facts_;
  TemporaryFolder folder_;
  const fs::path path_ = folder_.path() / "my.journal";
};

TEST_F(SessionJournalTest, frames_are_in_the_file_while_the_journal_is_open) {
  SessionJournal journal(path_, facts_, {}, 0.05);
  EXPECT_EQ(recorded(), 0U) << "the file is whole from the beginning";
  for (std::size_t i = 0; i < frames_.size(); ++i) {
    add(journal, frames_[i]);
    EXPECT_TRUE(soon([&] { return recorded() == i + 1; }));
  }
  const SessionRecording back = read_session_file(path_);
  for (std::size_t i = 0; i < frames_.size(); ++i) expect_same_frame(frames_[i], back.frames[i]);
  facts_.edits.add({{LoopEdit::Kind::kDelete, 1, 0}, {}});
  journal.update(facts_);
  EXPECT_TRUE(soon([&] { return !read_session_file(path_).facts.edits.empty(); }));
  EXPECT_FALSE(journal.failure());
}

TEST_F(SessionJournalTest, the_destructor_writes_the_rest) {
  {
    SessionJournal journal(path_, facts_, {}, 3600);
    for (const Frame& frame : frames_) add(journal, frame);
  }
  EXPECT_EQ(recorded(), frames_.size());
}

TEST_F(SessionJournalTest, begins_with_the_frames_of_a_session_that_is_resumed) {
  facts_.logs[0].scans = 3;
  { const SessionJournal first(path_, facts_, {frames_[0], frames_[1], frames_[2]}, 3600); }
  SessionJournal again(path_, facts_, read_session_file(path_).frames, 0.05);
  EXPECT_EQ(recorded(), 3U);
  add(again, frames_[3]);
  EXPECT_TRUE(soon([&] { return recorded() == 4; }));
}

TEST_F(SessionJournalTest, deletes_its_file_but_no_file_that_replaced_it) {
  {
    SessionJournal journal(path_, facts_, {}, 3600);
    journal.remove();
    EXPECT_FALSE(fs::exists(path_));
  }
  SessionJournal journal(path_, facts_, {}, 3600);
  facts_.logs[0].scans = frames_.size();
  write_session_file(path_, facts_, frames_);
  journal.remove();
  EXPECT_EQ(recorded(), frames_.size());
}

TEST_F(SessionJournalTest, a_folder_that_is_missing_is_an_error) {
  EXPECT_THROW(SessionJournal(folder_.path() / "none" / "my.journal", facts_, {}, 1), SystemFailure);
}

TEST_F(SessionJournalTest, is_complete_again_after_a_full_disk_has_room) {
  SessionJournal journal(path_, facts_, {}, 0.02);
  add(journal, frames_[0]);
  ASSERT_TRUE(soon([&] { return recorded() == 1; }));
  for (std::size_t failures = 0; failures < 2; ++failures) {
    const std::size_t before = 1 + failures;
    {
      const FullDisk full(fs::file_size(path_) + 100);
      add(journal, frames_[before]);
      ASSERT_TRUE(soon([&] { return journal.failure().has_value(); }));
      EXPECT_THAT(*journal.failure(), HasSubstr("cannot write " + path_.string()));
      const SessionRecording back = read_session_file(path_);
      EXPECT_EQ(back.frames.size(), before);
      EXPECT_TRUE(back.lost_end);
    }
    EXPECT_TRUE(soon([&] { return !journal.failure(); })) << "also without further scans";
    EXPECT_EQ(recorded(), before + 1);
  }
  add(journal, frames_[3]);
  EXPECT_TRUE(soon([&] { return recorded() == 4; }));
  const SessionRecording back = read_session_file(path_);
  EXPECT_FALSE(back.lost_end);
  for (std::size_t i = 0; i < back.frames.size(); ++i) expect_same_frame(frames_[i], back.frames[i]);
}

TEST_F(SessionJournalTest, the_destructor_tries_once_more) {
  for (const bool has_room : {false, true}) {
    auto journal = std::make_unique<SessionJournal>(path_, facts_, std::vector<Frame>(), 3600);
    auto full = std::make_unique<FullDisk>(fs::file_size(path_));
    add(*journal, frames_[0]);
    ASSERT_TRUE(soon([&] { return journal->failure().has_value(); }));
    if (has_room) full.reset();
    journal.reset();
    full.reset();
    EXPECT_EQ(recorded(), has_room ? 1U : 0U);
    facts_.logs[0].scans = 0;
  }
}

}  // namespace
}  // namespace psi_slam
