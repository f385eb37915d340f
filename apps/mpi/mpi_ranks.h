// SPDX-License-Identifier: BSD-3-Clause
// Work shared out among the ranks of an MPI job: rank 0 hands out orders, the others make them. What an order
// says is known to both sides alone.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "mpi_messages.h"

namespace psi_slam {

/// What rank 0 tells and is asked while its orders are made.
struct RankWatch {
  std::function<bool()> stop;                                           ///< once true, no more orders
  std::function<void(std::size_t order)> working;                       ///< a few times a second
  std::function<void(std::size_t order, const std::string&)> finished;  ///< what the maker returned
};

/// For rank 0, which is not alone: returns when all orders have been made, or stopped. What `finished` throws
/// is thrown then.
void hand_out(const MpiWorld& world, const std::vector<std::string>& orders, const RankWatch& watch);

/// Makes an order: what came of it, or none where `stop`, which it asks a few times a second, ended it.
using MakeOrder =
    std::function<std::optional<std::string>(const std::string& order, const std::function<bool()>& stop)>;

/// For the other ranks: makes what rank 0 hands out, until that dismisses them.
void work_for_rank_0(const MpiWorld& world, const MakeOrder& make);

/// For rank 0, at the end.
void dismiss_workers(const MpiWorld& world);

}  // namespace psi_slam
