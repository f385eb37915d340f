// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "gui/replay_snapshot.h"

namespace psi_slam {

/// Describes a loop, such as "Node 12 on local map 3, rejected: the response is too low: 0.31, minimum 0.45".
std::string describe_loop(const LoopRecord& loop);

/// Rows of the loop inspector: filters and sorts the loops of a snapshot and gives the texts of the cells.
class LoopTable {
 public:
  enum Column {
    kFrame,
    kNode,
    kLocalMap,
    kSearch,
    kResponse,
    kAmbiguity,
    kMoved,
    kResidual,
    kState,
    kReason,
  };
  static constexpr std::size_t kColumns = 10;
  static const char* title(std::size_t column);

  /// Shows the loops of a snapshot. Returns true if loops or node poses have changed since the last call.
  bool show(const std::shared_ptr<const ReplaySnapshot>& snapshot);
  /// Lists only loops in `state`, or all loops if it is empty.
  void set_filter(std::optional<LoopState> state);
  void sort_by(std::size_t column, bool ascending);
  std::size_t sorted_by() const { return column_; }
  bool ascending() const { return ascending_; }

  std::size_t rows() const { return order_.size(); }
  /// The index of a row's loop in ReplaySnapshot::loops.
  std::size_t loop_of(std::size_t row) const { return order_[row]; }
  std::optional<std::size_t> row_of(std::size_t loop) const;
  const LoopRecord& loop(std::size_t row) const { return (*snapshot_->loops)[order_[row]]; }
  std::string text(std::size_t row, std::size_t column) const;

  /// Counts the states, such as "120 searches: 35 accepted, 85 rejected".
  std::string summary() const;

 private:
  void arrange();
  struct Cell {
    double number = 0;  ///< first sort key, before `text`
    std::string text;
  };
  Cell cell(const LoopRecord& loop, std::size_t column) const;

  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<LoopState> filter_;
  std::size_t column_ = kFrame;
  bool ascending_ = true;
  std::vector<std::size_t> order_;
};

}  // namespace psi_slam
