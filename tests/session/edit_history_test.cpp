// SPDX-License-Identifier: BSD-3-Clause
#include "session/edit_history.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

using Kind = LoopEdit::Kind;

void expect_edit(const std::optional<AnyEdit>& edit, Kind kind, std::size_t frame) {
  ASSERT_TRUE(edit.has_value());
  EXPECT_EQ(std::get<LoopEdit>(*edit).kind, kind);
  EXPECT_EQ(std::get<LoopEdit>(*edit).frame, frame);
}

void expect_edit(const std::optional<EditHistory::Undo>& back, Kind kind, std::size_t frame) {
  ASSERT_TRUE(back.has_value());
  expect_edit(std::get<EditHistory::Reversal>(*back).edit, kind, frame);
}

TEST(EditHistory, undoes_the_newest_edit_first) {
  EditHistory history;
  history.note({Kind::kDelete, 1, 0}, std::nullopt);
  history.note({Kind::kForce, 2, 0}, std::nullopt);
  EXPECT_EQ(history.undo_text(), "force the loop of scan 2 with local map 0");
  expect_edit(history.undo(), Kind::kRestore, 2);
  expect_edit(history.undo(), Kind::kRestore, 1);
  EXPECT_FALSE(history.undo().has_value());
  EXPECT_EQ(history.undo_text(), "");
}

TEST(EditHistory, undo_restores_the_previous_edit_of_the_loop) {
  EditHistory history;
  history.note({Kind::kForce, 1, 0}, LoopEdit{Kind::kDelete, 1, 0});
  expect_edit(history.undo(), Kind::kDelete, 1);
  expect_edit(history.redo(), Kind::kForce, 1);
  expect_edit(history.undo(), Kind::kDelete, 1);
  EXPECT_FALSE(history.undo().has_value());
  history.note({Kind::kDelete, 1, 7}, std::nullopt);
  expect_edit(history.undo(), Kind::kRestore, 1);
}

TEST(EditHistory, undo_restores_planned_edits_of_the_loop) {
  EditHistory history;
  const TimedEdit later{{Kind::kForce, 1, 0}, {EditTime::Kind::kAfterScan, 1500}};
  history.note({Kind::kDelete, 1, 0}, std::nullopt, {later});
  for (int round = 0; round < 2; ++round) {
    const auto undo = history.undo();
    ASSERT_TRUE(undo.has_value());
    const auto& back = std::get<EditHistory::Reversal>(*undo);
    EXPECT_EQ(back.edit.kind, Kind::kRestore);
    ASSERT_EQ(back.later.size(), 1U);
    EXPECT_EQ(back.later[0].time.scan, 1500U);
    history.redo();
  }
}

TEST(EditHistory, redo_works_until_the_next_edit) {
  EditHistory history;
  history.note({Kind::kDelete, 1, 0}, std::nullopt);
  history.note({Kind::kDelete, 2, 0}, std::nullopt);
  EXPECT_FALSE(history.redo().has_value());
  history.undo();
  history.undo();
  EXPECT_EQ(history.redo_text(), "delete the loop of scan 1 with local map 0");
  expect_edit(history.redo(), Kind::kDelete, 1);
  expect_edit(history.redo(), Kind::kDelete, 2);
  history.undo();
  history.note({Kind::kForce, 3, 0}, std::nullopt);
  EXPECT_FALSE(history.redo().has_value());
  EXPECT_EQ(history.redo_text(), "");
}

TEST(EditHistory, has_edits_of_loops_and_of_the_map_in_one_order) {
  MapEdit wall;
  wall.kind = MapEdit::Kind::kWall;
  EditHistory history;
  history.note({Kind::kDelete, 1, 0}, std::nullopt);
  history.note(wall);
  EXPECT_EQ(history.undo_text(), "draw wall");
  EXPECT_TRUE(std::holds_alternative<MapEdit>(*history.next_undo()));
  const auto back = history.undo();
  ASSERT_TRUE(back && std::holds_alternative<MapEdit>(*back));
  EXPECT_EQ(std::get<MapEdit>(*back).kind, MapEdit::Kind::kWall);
  EXPECT_TRUE(std::holds_alternative<LoopEdit>(*history.next_undo()));
  EXPECT_EQ(history.redo_text(), "draw wall");
  expect_edit(history.undo(), Kind::kRestore, 1);
  EXPECT_EQ(history.next_undo(), nullptr);
  expect_edit(history.redo(), Kind::kDelete, 1);
  EXPECT_TRUE(std::holds_alternative<MapEdit>(history.redo().value()));
}

}  // namespace
}  // namespace psi_slam
