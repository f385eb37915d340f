// SPDX-License-Identifier: BSD-3-Clause
#include "loop_table.h"

#include <gmock/gmock.h>

namespace psi_slam {
namespace {

using testing::ElementsAre;

LoopRecord loop(std::size_t frame, double response, LoopState state) {
  LoopRecord record;
  record.frame = frame;
  record.node = 1;
  record.matcher = MatcherKind::kGa;
  record.search = SearchKind::kGenetic;
  record.response = response;
  record.state = state;
  if (state != LoopState::kAccepted)
    record.rejection = LoopRejection{LoopRejection::Reason::kLowResponse, 0.31, 0.45};
  return record;
}

class LoopTableTest : public testing::Test {
 protected:
  LoopTableTest() {
    auto snapshot = std::make_shared<ReplaySnapshot>();
    snapshot->map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(2);
    snapshot->loops = std::make_shared<std::vector<LoopRecord>>(
        std::vector<LoopRecord>{loop(7, 0.5, LoopState::kAccepted), loop(3, 0.3, LoopState::kRejected),
                                loop(5, 0.9, LoopState::kAccepted)});
    snapshot_ = snapshot;
    table_.show(snapshot_);
  }
  std::vector<std::size_t> order() const {
    std::vector<std::size_t> loops;
    for (std::size_t row = 0; row < table_.rows(); ++row) loops.push_back(table_.loop_of(row));
    return loops;
  }

  std::shared_ptr<const ReplaySnapshot> snapshot_;
  LoopTable table_;
};

TEST_F(LoopTableTest, sorts_by_frame_by_default_and_by_any_column) {
  EXPECT_THAT(order(), ElementsAre(1, 2, 0));
  table_.sort_by(LoopTable::kResponse, false);
  EXPECT_THAT(order(), ElementsAre(2, 0, 1));
  for (std::size_t column = 0; column < LoopTable::kColumns; ++column) {
    table_.sort_by(column, true);
    EXPECT_EQ(table_.rows(), 3U) << LoopTable::title(column);
  }
}

TEST_F(LoopTableTest, lists_loops_without_a_residual_last) {
  auto snapshot = std::make_shared<ReplaySnapshot>(*snapshot_);
  auto loops = *snapshot_->loops;
  loops[0].reference_T_node = {0.1, 0, 0};  // both nodes are at the origin
  loops[1].reference_T_node = {9, 0, 0};    // rejected, never a constraint
  loops[2].reference_T_node = {0.2, 0, 0};
  reject(loops[2], {LoopRejection::Reason::kContradicted});
  snapshot->loops = std::make_shared<std::vector<LoopRecord>>(loops);
  table_.show(snapshot);
  table_.sort_by(LoopTable::kResidual, true);
  EXPECT_THAT(order(), ElementsAre(0, 2, 1));
  EXPECT_EQ(table_.text(1, LoopTable::kResidual), "0.200");
  table_.sort_by(LoopTable::kResidual, false);
  EXPECT_THAT(order(), ElementsAre(2, 0, 1));
}

TEST_F(LoopTableTest, filters_by_state) {
  table_.set_filter(LoopState::kAccepted);
  EXPECT_THAT(order(), ElementsAre(2, 0));
  EXPECT_EQ(table_.row_of(0), 1U);
  EXPECT_FALSE(table_.row_of(1).has_value());
}

TEST_F(LoopTableTest, has_the_texts_of_all_cells) {
  EXPECT_EQ(table_.text(0, LoopTable::kFrame), "3");
  EXPECT_EQ(table_.text(0, LoopTable::kSearch), "genetic");
  EXPECT_EQ(table_.text(0, LoopTable::kResponse), "0.300");
  EXPECT_EQ(table_.text(0, LoopTable::kState), "rejected");
  EXPECT_EQ(table_.text(0, LoopTable::kReason), "the response is too low: 0.31, minimum 0.45");
  EXPECT_EQ(table_.text(0, LoopTable::kResidual), "") << "only constraints have a residual";
  EXPECT_EQ(table_.text(1, LoopTable::kResidual), "0.000");
  EXPECT_EQ(table_.summary(), "3 searches: 2 accepted, 1 rejected");
}

TEST_F(LoopTableTest, describes_a_loop_in_words) {
  EXPECT_EQ(describe_loop(table_.loop(0)),
            "Node 1 on local map 0, rejected: the response is too low: 0.31, minimum 0.45");
  EXPECT_EQ(describe_loop(table_.loop(1)), "Node 1 on local map 0, accepted");
}

TEST_F(LoopTableTest, reports_whether_loops_have_changed) {
  EXPECT_FALSE(table_.show(snapshot_));
  EXPECT_TRUE(table_.show(std::make_shared<ReplaySnapshot>()));
  EXPECT_EQ(table_.rows(), 0U);
}

}  // namespace
}  // namespace psi_slam
