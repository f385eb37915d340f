// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Records of attempts to close loops, and edits of loops by a person.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "psi_slam/matching.h"

namespace psi_slam {

/// State of an attempt to close a loop.
enum class LoopState {
  kCandidate,  ///< matched in a wide window, where one match proves little; waits until others agree
  kAccepted,   ///< a constraint of the pose graph
  kRejected,   ///< not a constraint; LoopRecord::rejection says why
};
/// All states.
inline constexpr std::array<LoopState, 3> kLoopStates{LoopState::kCandidate, LoopState::kAccepted,
                                                      LoopState::kRejected};

/// Returns "candidate", "accepted" or "rejected".
constexpr const char* state_text(LoopState state) {
  constexpr std::array<const char*, kLoopStates.size()> kTexts{"candidate", "accepted", "rejected"};
  return kTexts[static_cast<std::size_t>(state)];
}

/// Rule by which a loop was rejected.
struct LoopRejection {
  /// Test that the match failed, or edit that removed the loop.
  enum class Reason {
    kNothingFound,  ///< no match in the window: anchor_T_node is the predicted pose; limit: minimum response
    kLowResponse,   ///< value: response of the match
    kAmbiguous,     ///< value: 1 - prior * (1 - ambiguity)
    kUncertainPosition,   ///< value: largest standard deviation of the position, metres
    kUnobserved,          ///< value: share of the scan's points in space that the local map observed
    kNeighboursDisagree,  ///< value: share of the points of scans nearby on the path that fit the local map
    kReverseDisagrees,    ///< value: share of the local map's points that fit the scan
    kNoConsensus,         ///< too few other matches agree with this match in a wide window
    kContradicted,        ///< was accepted; value: residual in the optimised graph, standard deviations
    kDeletedByHand,       ///< a person deleted the loop
    kOtherMatchForced,    ///< a person forced another match of the same scan and local map
    kMatchedAgain,        ///< a person had the scan and local map matched again
    kMatchTakenBack,      ///< a person took back a match made by hand
  };
  Reason reason = Reason::kNothingFound;  ///< the test or edit
  double value = 0;                       ///< measured value; 0 for reasons without a value
  double limit = 0;                       ///< limit that the value violates, in the unit of the value
};

/// Returns the reason as a clause without figures: "the response is too low".
std::string text_of(LoopRejection::Reason reason);
/// Returns the reason as a clause with figures: "the response is too low: 0.48, minimum 0.50". Empty without
/// a rejection.
std::string text_of(const std::optional<LoopRejection>& rejection);

/// One attempt to close a loop, and its state. Attempts of the final search are recorded only if they found
/// a match. Values that an attempt did not reach are 0.
struct LoopRecord {
  std::size_t frame = 0;      ///< index of the scan in MappingResult::frames
  std::size_t node = 0;       ///< number of the node in the pose graph
  std::size_t local_map = 0;  ///< number of the matched local map
  std::size_t anchor = 0;     ///< anchor node of the local map
  /// Node where the constraint begins: the first of the path segment of the local map that is nearest to the
  /// scan. Errors of the path between this segment and the anchor do not enter the constraint.
  std::size_t reference = 0;
  MatcherKind matcher = MatcherKind::kCsm;      ///< matcher chosen for the window, by Psi or by a setting
  SearchKind search = SearchKind::kExhaustive;  ///< search that the matcher ran in the window
  bool in_final_search = false;                 ///< whether the final loop search found this match

  mrpt::math::TPose2D anchor_T_predicted;  ///< predicted pose of the node: centre of the search window
  mrpt::math::TPose2D anchor_T_node;       ///< matched pose of the node
  /// Covariance of (x, y, theta) of anchor_T_node, along the anchor's axes: m^2, m rad, rad^2.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  mrpt::math::TPose2D reference_T_node;  ///< matched pose of the node in the frame of `reference`
  SearchExtent window;                   ///< half-widths of the search window
  double response = 0;                   ///< response of the match, in [0, 1]
  double prior = 1;              ///< weight that the path gives to the matched position, see path_prior()
  double ambiguity = 0;          ///< response of the second-best distinct peak, divided by the best
  double observed_share = 0;     ///< share of the scan's points in space that the local map observed
  double neighbours_agree = 0;   ///< share of the points of scans nearby on the path that fit the local map
  double reverse_agree = 0;      ///< share of the local map's points in view of the scan that fit the scan
  double moved_m = 0;            ///< distance from the predicted to the matched position
  std::int64_t evaluations = 0;  ///< number of poses scored
  double milliseconds = 0;       ///< time of the match, without verification

  LoopState state = LoopState::kCandidate;  ///< state so far
  std::optional<LoopRejection> rejection;   ///< rule of a rejected loop; empty in all other states
  bool by_hand = false;  ///< whether a person deleted, forced or matched the loop, see LoopEdit
};

/// Rejects a loop by a rule.
inline void reject(LoopRecord& loop, const LoopRejection& rejection) {
  loop.state = LoopState::kRejected;
  loop.rejection = rejection;
}

/// Returns whether the loop was rejected for this reason.
inline bool rejected_by(const LoopRecord& loop, LoopRejection::Reason reason) {
  return loop.rejection && loop.rejection->reason == reason;
}

/// Returns whether the loop was rejected because its window contains no match.
inline bool found_nothing(const LoopRecord& loop) {
  return rejected_by(loop, LoopRejection::Reason::kNothingFound);
}

/// Returns whether the loop was accepted first, and then rejected because the rest of the graph contradicts
/// it.
inline bool is_outlier(const LoopRecord& loop) {
  return rejected_by(loop, LoopRejection::Reason::kContradicted);
}

/// Returns the chosen matcher and the search that it ran: "csm_ga (local)".
std::string searched_by(const LoopRecord& loop);

/// Cost of a number of searches.
struct SearchCost {
  std::size_t attempts = 0;      ///< number of windows searched
  std::size_t found = 0;         ///< windows in which a match was found
  std::int64_t evaluations = 0;  ///< number of poses scored
  double milliseconds = 0;       ///< time of matching without verification, summed over the attempts

  /// Adds the cost of further searches.
  SearchCost& operator+=(const SearchCost& other) {
    attempts += other.attempts;
    found += other.found;
    evaluations += other.evaluations;
    milliseconds += other.milliseconds;
    return *this;
  }
};

/// Cost of searching for loops, successful or not.
struct LoopEffort : SearchCost {
  /// The same cost, split by the search that ran, in the order of kSearchKinds.
  std::array<SearchCost, kSearchKinds.size()> by_search{};

  /// Cost of the searches of one kind.
  const SearchCost& of(SearchKind search) const { return by_search[static_cast<std::size_t>(search)]; }

  /// Adds searches of one kind.
  void add(SearchKind search, const SearchCost& cost) {
    SearchCost::operator+=(cost);
    by_search[static_cast<std::size_t>(search)] += cost;
  }

  /// Adds the cost of further searches.
  LoopEffort& operator+=(const LoopEffort& other) {
    SearchCost::operator+=(other);
    for (std::size_t i = 0; i < by_search.size(); ++i) by_search[i] += other.by_search[i];
    return *this;
  }
};

/// Search window of a match by hand.
struct LoopPlace {
  mrpt::math::TPose2D anchor_T_node;  ///< centre of the window: pose of the node in the anchor's frame
  SearchExtent window;                ///< half-widths of the window
};

/// A person's correction of one loop. Scan and local map identify the loop. Scans and local maps have the
/// same numbers whenever a log is mapped with the same front-end options.
struct LoopEdit {
  /// What to do with the loop.
  enum class Kind {
    kDelete,   ///< removes the loop, even if it passed verification
    kForce,    ///< makes the match a constraint, even if it was rejected; forced loops are never rejected
    kMatch,    ///< matches again with `matcher` and `place`; accepts a verified match at once
    kRestore,  ///< undoes an earlier edit of this loop
  };

  Kind kind = Kind::kDelete;  ///< what to do with the loop
  std::size_t frame = 0;      ///< index of the scan in MappingResult::frames; the scan must be a node
  std::size_t local_map = 0;  ///< number of the local map

  /// For kForce: forces the match found by the final search instead of an earlier match.
  bool of_final_search = false;

  /// For kMatch: the matcher to use.
  MatcherKind matcher = MatcherKind::kCsm;
  /// For kMatch: where to search. Empty: the window of the last attempt; without an earlier attempt, the
  /// largest window around the pose that the graph predicts.
  std::optional<LoopPlace> place{};
};

/// Returns whether two edits concern the same loop.
inline bool same_loop(const LoopEdit& a, const LoopEdit& b) {
  return a.frame == b.frame && a.local_map == b.local_map;
}
/// Returns whether the edit concerns the loop.
inline bool same_loop(const LoopRecord& loop, const LoopEdit& edit) {
  return loop.frame == edit.frame && loop.local_map == edit.local_map;
}

/// Returns the edit as a command: "delete the loop of scan 812 with local map 14".
std::string text_of(const LoopEdit& edit);

}  // namespace psi_slam
