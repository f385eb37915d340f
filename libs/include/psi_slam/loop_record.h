// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <string>

#include "matching/search_window.h"

namespace psi_slam {

enum class LoopVerdict {
  kAccepted,
  kPending,      ///< found in a wide window: waits for other matches to agree; refused if none does
  kRefused,      ///< by verification: it never became a constraint
  kSwitchedOff,  ///< accepted first, but the rest of the graph contradicts it
  kNotFound,     ///< no pose of the window scores near enough: anchor_T_node is the prediction
  kDeleted,      ///< by a person
};

/// One attempt to close a loop, and what became of it. Of the last pass, which tries every pair of
/// neighbours, those that found a match.
struct LoopRecord {
  std::size_t frame = 0;      ///< in the log's order
  std::size_t node = 0;       ///< of the graph
  std::size_t local_map = 0;  ///< number of the local map it was matched with
  std::size_t anchor = 0;     ///< the local map's anchor node: the constraint is anchor -> node
  std::string matcher;        ///< "csm", ...
  bool in_final_search = false;  ///< by the global pass after the last scan

  mrpt::math::TPose2D anchor_T_predicted;  ///< the node as the graph had it: the middle of the window
  mrpt::math::TPose2D anchor_T_node;       ///< as matched
  Eigen::Matrix3d covariance =
      Eigen::Matrix3d::Zero();  ///< of anchor_T_node, along the anchor's axes: m, m, rad
  SearchExtent window;          ///< half-widths searched
  double response = 0;          ///< in [0, 1]
  double ambiguity = 0;  ///< response of the next best distinct peak over the best; 0 unique .. 1 ambiguous
  double observed_share = 0;    ///< of the scan's points, those in space that the local map has observed
  double neighbours_agree = 0;  ///< share of the neighbouring scans' points that fit the local map
  double reverse_agree = 0;     ///< share of the local map's points seen from the scan that fit it
  double moved_m = 0;           ///< how far from the prediction the match was found
  std::int64_t evaluations = 0;
  double milliseconds = 0;  ///< of matching

  LoopVerdict verdict = LoopVerdict::kRefused;
  std::string reason;    ///< why it is no constraint, as a clause; empty when accepted
  bool by_hand = false;  ///< a person deleted it, forced it or had it matched, see LoopEdit
};

}  // namespace psi_slam
