// SPDX-License-Identifier: BSD-3-Clause
// Reports how much of a long work is done.
#pragma once

#include <functional>
#include <utility>

namespace psi_slam {

/// Receives the completed share of a work, in [0, 1]. May throw to end the work. May be empty.
using ShareObserver = std::function<void(double share)>;

/// Returns an observer of a part of a work: from the share `begin` of the whole work to the share `end`.
inline ShareObserver part_of(ShareObserver whole, double begin, double end) {
  if (!whole) return {};
  return [whole = std::move(whole), begin, end](double share) { whole(begin + share * (end - begin)); };
}

}  // namespace psi_slam
