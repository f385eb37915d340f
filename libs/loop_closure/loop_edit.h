// SPDX-License-Identifier: BSD-3-Clause
// What a person changes about a loop where the world fooled the mapper. A loop is named by its scan and its
// local map, which are the same in every run of a log with the same front end.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <optional>
#include <string>

#include "psi_slam/loop_record.h"
#include "matching/make_matcher.h"
#include "matching/search_window.h"

namespace psi_slam {

/// Where a match is looked for.
struct LoopPlace {
  mrpt::math::TPose2D anchor_T_node;  ///< the middle of the window
  SearchExtent window;
};

struct LoopEdit {
  enum class Kind {
    kDelete,   ///< the loop is none, whatever its match says
    kForce,    ///< its match, refused or not, is a constraint that nothing switches off
    kMatch,    ///< matched as told here; what verification accepts is a constraint, wide windows included
    kRestore,  ///< takes back the others: the loop is what the mapper makes of it
  };

  Kind kind = Kind::kDelete;
  std::size_t frame = 0;      ///< of the scan, in the log's order; it must have become a node
  std::size_t local_map = 0;  ///< its number

  /// Of kForce only: the match that the last pass finds, not one that was found on the way.
  bool of_final_search = false;

  // Of kMatch only.
  MatcherKind matcher = MatcherKind::kCsm;
  /// None: where the loop was looked for before, or else where the graph expects it, in the largest window.
  std::optional<LoopPlace> place{};
};

inline bool same_loop(const LoopEdit& a, const LoopEdit& b) {
  return a.frame == b.frame && a.local_map == b.local_map;
}
inline bool same_loop(const LoopRecord& loop, const LoopEdit& edit) {
  return loop.frame == edit.frame && loop.local_map == edit.local_map;
}

/// What an edit asks for: "delete the loop of scan 812 with local map 14".
std::string text_of(const LoopEdit& edit);

}  // namespace psi_slam
