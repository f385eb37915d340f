// SPDX-License-Identifier: BSD-3-Clause
// All attempts to close a loop, which of them are constraints of the pose graph, and what a person changed
// about them. A plain value: copied together with its graph, it can be gone back to.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "psi_slam/loop_record.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"
#include "pose_graph/sparse_pose_adjustment.h"

namespace psi_slam {

/// The noise of a loop on top of its match's covariance.
struct LoopNoise {
  double sigma_m = 0;
  double sigma_rad = 0;
};

/// A scan, by its node, and a local map.
using LoopPair = std::pair<std::size_t, std::size_t>;

class LoopLedger {
 public:
  explicit LoopLedger(const LoopNoise& noise) : noise_(noise) {}

  const std::vector<LoopRecord>& loops() const { return loops_; }
  /// The last thing that is asked of a ledger.
  std::vector<LoopRecord> take_loops() { return std::move(loops_); }

  /// Enters an attempt and returns its number. Where a person has deleted or forced the loop of this pair,
  /// its verdict becomes what they want.
  std::size_t add(LoopRecord loop);

  /// Makes a constraint of a loop that is accepted or pending; returns by how many standard deviations of
  /// loops the graph contradicts it. None, and nothing happens, where it is a constraint already or no longer
  /// to be one.
  std::optional<double> accept(std::size_t loop, PoseGraph& graph);

  /// Optimises the graph, and switches off the loops that it contradicts by more than `max_chi` standard
  /// deviations; never those that a person forced.
  void settle(PoseGraph& graph, SparsePoseAdjustment& solver, double max_chi);

  void refuse_pending();

  /// The pairs that a last search for loops leaves out: those whose loop is more than refused, those that it
  /// has tried before, and those whose match a person has settled.
  std::set<LoopPair> searched_pairs() const;

  // What a person does. It holds for attempts that come later, too.

  void remove(const LoopPair& pair, PoseGraph& graph);
  /// False when no match of the pair has been found: the first that comes is taken. With `of_final_search` only
  /// one that the last pass finds will do.
  bool force(const LoopPair& pair, bool of_final_search, PoseGraph& graph);
  /// `loop` is what the person had matched: it stands instead of what was found before.
  void replace(LoopRecord loop, PoseGraph& graph);
  /// Takes back the other three. False when there is nothing to take back.
  bool restore(const LoopPair& pair, PoseGraph& graph);

  std::vector<LoopPair> forced_in_vain() const;

  /// The newest attempt of the pair, or null.
  const LoopRecord* find(const LoopPair& pair) const;

 private:
  /// An attempt as it was.
  struct Entry {
    std::size_t loop = 0;
    LoopRecord record;
    std::optional<std::size_t> constraint;
  };
  /// What a person wants of a pair, and its attempts as they were before.
  struct ByHand {
    LoopEdit::Kind kind = LoopEdit::Kind::kDelete;
    bool of_final_search = false;  ///< see force()
    std::vector<Entry> before;
  };

  std::vector<std::size_t> attempts_of(const LoopPair& pair) const;
  /// Begins anew from what the mapper itself had found.
  void take_over(const LoopPair& pair, LoopEdit::Kind kind, PoseGraph& graph);
  std::size_t enter(LoopRecord loop);
  void link(std::size_t loop, std::size_t constraint);
  void strike(std::size_t loop, LoopRefusal::Reason reason, PoseGraph& graph);

  LoopNoise noise_;
  std::vector<LoopRecord> loops_;
  std::vector<std::optional<std::size_t>> constraint_of_;  ///< by loop
  /// Those that are constraints, switched off or not: constraint, loop. In the order they became so.
  std::vector<std::pair<std::size_t, std::size_t>> constraints_;
  std::map<LoopPair, ByHand> by_hand_;
};

}  // namespace psi_slam
