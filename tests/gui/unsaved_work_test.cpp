// SPDX-License-Identifier: BSD-3-Clause
#include "unsaved_work.h"

#include <gtest/gtest.h>

#include <memory>

namespace psi_slam {
namespace {

std::shared_ptr<const EditJournal> edits(std::size_t count) {
  auto all = std::make_shared<EditJournal>();
  for (std::size_t i = 0; i < count; ++i)
    all->add({{LoopEdit::Kind::kDelete, 100 + i, 2}, {EditTime::Kind::kAfterScan, 120}});
  return all;
}

ReplaySnapshot snapshot(std::size_t scans, std::size_t edit_count) {
  ReplaySnapshot now;
  SharedHistory<FrameRecord> frames;
  for (std::size_t i = 0; i < scans; ++i) frames.push_back({});
  now.frames = frames.view();
  now.edits = edits(edit_count);
  return now;
}

class UnsavedWorkTest : public testing::Test {
 protected:
  UnsavedWorkTest() { work_.open(SessionInput("my.log").with_edits(*edits(1))); }

  UnsavedWork work_;
};

TEST_F(UnsavedWorkTest, opening_a_log_leaves_no_unsaved_work) {
  EXPECT_FALSE(work_.any(snapshot(0, 1))) << "the edit comes from the file";
}

TEST_F(UnsavedWorkTest, scans_are_unsaved_until_they_are_written) {
  EXPECT_TRUE(work_.any(snapshot(1, 1)));
  EXPECT_FALSE(work_.any_edits(snapshot(1, 1)));
  work_.note_written({100, edits(1)});
  EXPECT_FALSE(work_.any(snapshot(100, 1)));
  EXPECT_TRUE(work_.any(snapshot(101, 1))) << "the session was saved half-way";
}

TEST_F(UnsavedWorkTest, edits_are_unsaved_until_they_are_written) {
  EXPECT_TRUE(work_.any_edits(snapshot(0, 2)));
  EXPECT_TRUE(work_.any_edits(snapshot(0, 0))) << "the edit of the file was undone";
  work_.note_written_edits(*edits(2));
  EXPECT_FALSE(work_.any_edits(snapshot(150, 2)));
  EXPECT_TRUE(work_.any(snapshot(150, 2))) << "the map was not written";
  EXPECT_TRUE(work_.any_edits(snapshot(150, 3)));
}

TEST_F(UnsavedWorkTest, edits_of_the_drawn_map_count) {
  ReplaySnapshot now = snapshot(0, 1);
  EditJournal drawn = *now.edits;
  drawn.add(MapEdit{MapEdit::Kind::kWall, {{0, 0}, {1, 0}}});
  now.edits = std::make_shared<EditJournal>(drawn);
  EXPECT_TRUE(work_.any_edits(now));
  work_.note_written_edits(drawn);
  EXPECT_FALSE(work_.any(now));
}

TEST_F(UnsavedWorkTest, edits_stay_unsaved_after_a_restart) {
  work_.note_written({150, edits(1)});
  work_.restart(SessionInput("my.log").with_edits(*edits(2)));
  EXPECT_TRUE(work_.any(snapshot(0, 2)));
  EXPECT_TRUE(work_.any(snapshot(20, 1))) << "these scans were mapped again";
}

TEST_F(UnsavedWorkTest, scans_of_a_session_are_saved) {
  const auto recording = std::make_shared<SessionRecording>();
  recording->frames.resize(40);
  recording->facts.logs.push_back({});
  work_.open(SessionInput(recording));
  EXPECT_FALSE(work_.any(snapshot(40, 0)));
  EXPECT_TRUE(work_.any(snapshot(41, 0)));
}

}  // namespace
}  // namespace psi_slam
