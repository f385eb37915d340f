// SPDX-License-Identifier: BSD-3-Clause
// Records all attempts to close loops, the constraints made from them, and the edits by hand. To save a state
// that can be restored, copy the ledger and its graph.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "mapping/loop_closure/outlier_loops.h"
#include "pose_graph/sparse_pose_adjustment.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/pose_graph.h"

namespace psi_slam {

/// Extra noise of each loop match: standard deviations, whose squares are added to the match's covariance.
struct LoopNoise {
  double sigma_m = 0;
  double sigma_rad = 0;
};

/// Number of a node and number of a local map.
using LoopPair = std::pair<std::size_t, std::size_t>;

class LoopLedger {
 public:
  explicit LoopLedger(const LoopNoise& noise) : noise_(noise) {}

  const std::vector<LoopRecord>& loops() const { return loops_; }
  /// Moves the loops out of the ledger. No other function may be called afterwards.
  std::vector<LoopRecord> take_loops() { return std::move(loops_); }

  /// Adds an attempt and returns its number. If a person deleted or forced the loop of the same node and
  /// local map, the edit determines the state.
  std::size_t add(LoopRecord loop);

  /// Makes an accepted loop or a candidate a constraint of the graph. Returns the larger of the loop's
  /// position and heading residuals at the graph's poses, in standard deviations of LoopNoise. Does nothing
  /// and returns nothing if the loop is rejected or already is a constraint.
  std::optional<double> accept(std::size_t loop, PoseGraph& graph);

  /// Optimises the graph and rejects outlier loops, see reject_outlier_loops(). Never rejects forced loops.
  void settle(PoseGraph& graph, SparsePoseAdjustment& solver);

  /// A forced loop that the rest of the graph contradicts.
  struct ContradictedForce {
    LoopPair pair;
    double chi = 0;  ///< see contradiction()
  };
  /// Returns the forced loops whose contradiction() by the rest of the graph exceeds kInlierChi, in the order
  /// of their pairs. For each forced loop, decides anew which other loops are outliers, because loops that
  /// agree with the path may have been rejected because of the forced loop. Omits a loop whose
  /// contradiction() cannot be computed.
  std::vector<ContradictedForce> contradicted_forces(const PoseGraph& graph,
                                                     SparsePoseAdjustment& solver) const;

  void reject_candidates();

  /// Returns the pairs that the final search skips. These pairs have a candidate, an accepted or an
  /// outlier loop, were matched by an earlier pass, or were edited by a person.
  std::set<LoopPair> searched_pairs() const;

  // Edits by hand. Each edit also applies to later attempts of the same node and local map.

  void remove(const LoopPair& pair, PoseGraph& graph);
  /// Accepts the newest match of the pair by force. If there is no match yet, returns false and forces the
  /// next match of the pair. If `of_final_search` is true, only matches of the final search count.
  bool force(const LoopPair& pair, bool of_final_search, PoseGraph& graph);
  /// Replaces the earlier attempts of the pair by `loop`, the result of a match by hand.
  void replace(LoopRecord loop, PoseGraph& graph);
  /// Undoes remove(), force() and replace() of the pair. Returns false if there was no such edit.
  bool restore(const LoopPair& pair, PoseGraph& graph);

  /// Returns the pairs passed to force() that have no accepted loop, because no match was found.
  std::vector<LoopPair> forced_in_vain() const;

  /// Returns the newest attempt of the pair, or null. The pointer is valid until the ledger changes.
  const LoopRecord* find(const LoopPair& pair) const;

 private:
  /// State of an attempt before an edit by hand.
  struct Entry {
    std::size_t loop = 0;
    LoopRecord record;
    std::optional<std::size_t> constraint;
  };
  /// An edit by hand, and the attempts of its pair as they were before it.
  struct ByHand {
    LoopEdit::Kind kind = LoopEdit::Kind::kDelete;
    bool of_final_search = false;  ///< see force()
    std::vector<Entry> before;
  };

  std::vector<std::size_t> attempts_of(const LoopPair& pair) const;
  /// Prepares an edit by hand: undoes earlier edits of the pair, and saves its attempts.
  void take_over(const LoopPair& pair, LoopEdit::Kind kind, PoseGraph& graph);
  std::size_t enter(LoopRecord loop);
  void add_constraint(std::size_t loop, PoseGraph& graph);
  void link(std::size_t loop, std::size_t constraint);
  bool is_forced(std::size_t loop) const;
  /// Returns the constraints of the loops that are not forced, and the numbers of these loops.
  std::pair<std::vector<std::size_t>, std::vector<std::size_t>> unforced() const;
  void strike(std::size_t loop, LoopRejection::Reason reason, PoseGraph& graph);

  LoopNoise noise_;
  std::vector<LoopRecord> loops_;
  std::vector<std::optional<std::size_t>> constraint_of_;  ///< constraint number of each loop; empty: none
  /// Pairs of constraint and loop, enabled or not, in the order in which they were accepted.
  std::vector<std::pair<std::size_t, std::size_t>> constraints_;
  std::map<LoopPair, ByHand> by_hand_;
};

}  // namespace psi_slam
