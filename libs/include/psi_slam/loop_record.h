// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Attempts to close loops: the outcome of each attempt, and the changes that a person makes by hand.
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

/// Outcome of an attempt to close a loop.
enum class LoopVerdict {
  kAccepted,     ///< a constraint of the pose graph
  kPending,      ///< found in a wide window; waits until other matches agree
  kRefused,      ///< refused by verification; never was a constraint
  kSwitchedOff,  ///< accepted first, then contradicted by the rest of the graph
  kNotFound,     ///< no pose of the window scores high enough; anchor_T_node is the prediction
  kDeleted,      ///< deleted by a person
};
/// All verdicts.
inline constexpr std::array<LoopVerdict, 6> kLoopVerdicts{LoopVerdict::kAccepted, LoopVerdict::kPending,
                                                          LoopVerdict::kRefused,  LoopVerdict::kSwitchedOff,
                                                          LoopVerdict::kNotFound, LoopVerdict::kDeleted};

/// "accepted", "pending", "refused", "switched off", "not found" or "deleted".
constexpr const char* verdict_text(LoopVerdict verdict) {
  constexpr std::array<const char*, kLoopVerdicts.size()> kTexts{"accepted",     "pending",   "refused",
                                                                 "switched off", "not found", "deleted"};
  return kTexts[static_cast<std::size_t>(verdict)];
}

/// Why an attempt is not a constraint.
struct LoopRefusal {
  /// Test that the match failed, or edit that removed it.
  enum class Reason {
    kNothingFound,        ///< limit: minimum response of the search
    kLowResponse,         ///< value: response
    kAmbiguous,           ///< value: response of the second-best place over the best
    kUncertainPosition,   ///< value: largest standard deviation of the position, metres
    kUnobserved,          ///< value: share of the scan in space that the local map observed
    kNeighboursDisagree,  ///< value: share of the neighbouring scans' points that fit the local map
    kReverseDisagrees,    ///< value: share of the local map's points that fit the scan
    kNoConsensus,         ///< too few other matches agree with a match in a wide window
    kContradicted,        ///< value: residual in the optimised graph, standard deviations
    kDeletedByHand,       ///< a person deleted the loop
    kOtherMatchForced,    ///< a person forced another match of the same scan and local map
    kMatchedAgain,        ///< a person had the pair matched again
    kMatchTakenBack,      ///< a match made by hand that a person took back
  };
  Reason reason = Reason::kNothingFound;  ///< the test or edit
  double value = 0;                       ///< measured value; 0 for reasons without one
  double limit = 0;                       ///< limit that the value breaks, in the same unit
};

/// The reason as a clause without figures: "the response is too low".
std::string text_of(LoopRefusal::Reason reason);
/// The reason as a clause with figures: "the response is too low: 0.48, minimum 0.50". Empty for no refusal.
std::string text_of(const std::optional<LoopRefusal>& refusal);

/// One attempt to close a loop, and its outcome. Attempts of the final search are recorded only if they found
/// a match.
struct LoopRecord {
  std::size_t frame = 0;      ///< in the log's order
  std::size_t node = 0;       ///< of the graph
  std::size_t local_map = 0;  ///< number of the matched local map
  std::size_t anchor = 0;     ///< anchor node of the local map; the constraint is anchor -> node
  MatcherKind matcher = MatcherKind::kCsm;  ///< matcher that searched the window
  bool in_final_search = false;             ///< found in the search after the last scan

  mrpt::math::TPose2D anchor_T_predicted;  ///< pose predicted by the graph: centre of the window
  mrpt::math::TPose2D anchor_T_node;       ///< matched pose
  /// Covariance of anchor_T_node along the anchor's axes: m, m, rad.
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  SearchExtent window;           ///< half-widths searched
  double response = 0;           ///< in [0, 1]
  double ambiguity = 0;          ///< response of the second-best distinct peak over the best, in [0, 1]
  double observed_share = 0;     ///< share of the scan's points in space that the local map observed
  double neighbours_agree = 0;   ///< share of the neighbouring scans' points that fit the local map
  double reverse_agree = 0;      ///< share of the local map's points seen from the scan that fit it
  double moved_m = 0;            ///< distance from the predicted to the matched position
  std::int64_t evaluations = 0;  ///< poses scored
  double milliseconds = 0;       ///< of matching

  LoopVerdict verdict = LoopVerdict::kRefused;  ///< outcome so far
  std::optional<LoopRefusal> refusal;           ///< none for accepted and pending loops
  bool by_hand = false;                         ///< deleted, forced or matched by a person, see LoopEdit
};

/// Cost of searching for loops, successful or not.
struct LoopEffort {
  std::size_t attempts = 0;      ///< windows searched
  std::size_t found = 0;         ///< windows with a match; each is a LoopRecord
  std::int64_t evaluations = 0;  ///< poses scored
  double milliseconds = 0;       ///< of matching, summed over the attempts; without verification

  /// Adds the cost of other searches.
  LoopEffort& operator+=(const LoopEffort& other) {
    attempts += other.attempts;
    found += other.found;
    evaluations += other.evaluations;
    milliseconds += other.milliseconds;
    return *this;
  }
};

/// Where a match by hand is searched.
struct LoopPlace {
  mrpt::math::TPose2D anchor_T_node;  ///< centre of the window
  SearchExtent window;                ///< half-widths of the window
};

/// A person's correction of one loop. Scan and local map identify the loop; their numbers are the same in
/// every run of a log with the same front end.
struct LoopEdit {
  /// What to do with the loop.
  enum class Kind {
    kDelete,   ///< removes the loop, whatever its match says
    kForce,    ///< makes the match, refused or not, a constraint that nothing switches off
    kMatch,    ///< matches again as given here; a verified match is accepted, in wide windows too
    kRestore,  ///< undoes the changes of the other kinds
  };

  Kind kind = Kind::kDelete;  ///< what to do with the loop
  std::size_t frame = 0;      ///< scan in the log's order; it must be a node
  std::size_t local_map = 0;  ///< number of the local map

  /// For kForce: forces the match that the final search finds, not one found before.
  bool of_final_search = false;

  /// For kMatch: the matcher to use.
  MatcherKind matcher = MatcherKind::kCsm;
  /// For kMatch: where to search. None: where the loop was searched before, or else around the pose that the
  /// graph predicts, in the largest window.
  std::optional<LoopPlace> place{};
};

/// Whether two edits concern the same loop.
inline bool same_loop(const LoopEdit& a, const LoopEdit& b) {
  return a.frame == b.frame && a.local_map == b.local_map;
}
/// Whether the edit concerns the loop.
inline bool same_loop(const LoopRecord& loop, const LoopEdit& edit) {
  return loop.frame == edit.frame && loop.local_map == edit.local_map;
}

/// The edit as a command: "delete the loop of scan 812 with local map 14".
std::string text_of(const LoopEdit& edit);

}  // namespace psi_slam
