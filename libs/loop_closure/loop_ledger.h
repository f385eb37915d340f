// SPDX-License-Identifier: BSD-3-Clause
// All attempts to close loops, the constraints that they became, and the changes by hand. A plain value: a
// copy of it and of its graph is a state that can be restored.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Noise of a loop, added to its match's covariance.
struct LoopNoise {
  double sigma_m = 0;
  double sigma_rad = 0;
};

/// A node and a local map.
using LoopPair = std::pair<std::size_t, std::size_t>;

class LoopLedger {
 public:
  explicit LoopLedger(const LoopNoise& noise) : noise_(noise) {}

  const std::vector<LoopRecord>& loops() const { return loops_; }
  /// Moves the loops out. Call nothing else afterwards.
  std::vector<LoopRecord> take_loops() { return std::move(loops_); }

  /// Adds an attempt and returns its number. If a person deleted or forced the loop of this pair, its verdict
  /// follows.
  std::size_t add(LoopRecord loop);

  /// Makes an accepted or pending loop a constraint. Returns its residual in standard deviations of the loop
  /// noise. Does nothing and returns none for other loops and existing constraints.
  std::optional<double> accept(std::size_t loop, PoseGraph& graph);

  /// Optimises the graph and switches off loops with residuals above `max_chi` standard deviations, except
  /// forced ones.
  void settle(PoseGraph& graph, SparsePoseAdjustment& solver, double max_chi);

  void refuse_pending();

  /// Pairs that the final search leaves out: loops that were not refused, pairs that it has tried before, and
  /// pairs that a person decided.
  std::set<LoopPair> searched_pairs() const;

  // Changes by hand. They also hold for later attempts.

  void remove(const LoopPair& pair, PoseGraph& graph);
  /// False if there is no match of the pair yet; then the first one to come is forced. With `of_final_search`
  /// it must be a match of the final search.
  bool force(const LoopPair& pair, bool of_final_search, PoseGraph& graph);
  /// Replaces earlier attempts of the pair by `loop`, a match by hand.
  void replace(LoopRecord loop, PoseGraph& graph);
  /// Undoes remove(), force() and replace() of the pair. False if there was no change.
  bool restore(const LoopPair& pair, PoseGraph& graph);

  /// Forced pairs without an accepted loop.
  std::vector<LoopPair> forced_in_vain() const;

  /// The newest attempt of the pair, or null.
  const LoopRecord* find(const LoopPair& pair) const;

 private:
  /// An attempt before a change by hand.
  struct Entry {
    std::size_t loop = 0;
    LoopRecord record;
    std::optional<std::size_t> constraint;
  };
  /// A change by hand, and the pair's attempts before it.
  struct ByHand {
    LoopEdit::Kind kind = LoopEdit::Kind::kDelete;
    bool of_final_search = false;  ///< see force()
    std::vector<Entry> before;
  };

  std::vector<std::size_t> attempts_of(const LoopPair& pair) const;
  /// Starts a change by hand from the attempts of the mapper, without earlier changes.
  void take_over(const LoopPair& pair, LoopEdit::Kind kind, PoseGraph& graph);
  std::size_t enter(LoopRecord loop);
  void link(std::size_t loop, std::size_t constraint);
  void strike(std::size_t loop, LoopRefusal::Reason reason, PoseGraph& graph);

  LoopNoise noise_;
  std::vector<LoopRecord> loops_;
  std::vector<std::optional<std::size_t>> constraint_of_;  ///< by loop
  /// Constraint and loop, enabled or not, in the order of accept().
  std::vector<std::pair<std::size_t, std::size_t>> constraints_;
  std::map<LoopPair, ByHand> by_hand_;
};

}  // namespace psi_slam
