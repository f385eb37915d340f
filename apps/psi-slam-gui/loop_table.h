// SPDX-License-Identifier: BSD-3-Clause
// The rows and columns of the loop inspector: which loops are listed, in which order, and what stands in the
// cells.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "replay/replay_snapshot.h"

namespace psi_slam {

/// "Node 12 on local map 3, refused: the response 0.31 is below 0.45".
std::string loop_words(const LoopRecord& loop);

class LoopTable {
 public:
  enum Column {
    kFrame,
    kNode,
    kLocalMap,
    kMatcher,
    kResponse,
    kAmbiguity,
    kMoved,
    kResidual,
    kVerdict,
    kReason,
  };
  static constexpr std::size_t kColumns = 10;
  static const char* title(std::size_t column);

  /// Lists the loops of a snapshot anew if it has others. True when they changed.
  bool show(const std::shared_ptr<const ReplaySnapshot>& snapshot);
  /// Only those with this verdict; none: all.
  void set_filter(std::optional<LoopVerdict> verdict);
  void sort_by(std::size_t column, bool ascending);
  std::size_t sorted_by() const { return column_; }
  bool ascending() const { return ascending_; }

  std::size_t rows() const { return order_.size(); }
  /// The index of a row's loop in ReplaySnapshot::loops.
  std::size_t loop_of(std::size_t row) const { return order_[row]; }
  std::optional<std::size_t> row_of(std::size_t loop) const;
  const LoopRecord& loop(std::size_t row) const { return (*snapshot_->loops)[order_[row]]; }
  std::string text(std::size_t row, std::size_t column) const;

  /// "120 searches: 35 accepted, 80 refused, 5 switched off".
  std::string summary() const;

 private:
  void arrange();
  /// Of loops that the graph holds or has switched off.
  std::optional<double> residual_m(const LoopRecord& loop) const;

  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<LoopVerdict> filter_;
  std::size_t column_ = kFrame;
  bool ascending_ = true;
  std::vector<std::size_t> order_;
};

}  // namespace psi_slam
