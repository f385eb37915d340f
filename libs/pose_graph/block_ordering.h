// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

namespace psi_slam {

/// An order of elimination that keeps the Cholesky factor of a symmetric block matrix sparse: approximate
/// minimum degree (Amestoy, Davis, Duff 1996) on the graph of the blocks, a third of the size of the scalar
/// one. `links` are the blocks off the diagonal, each once or more, as (row, column) in either order. Returns
/// order[k] = the variable that is eliminated k-th.
std::vector<std::uint32_t> fill_reducing_order(
    std::size_t num_variables, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& links);

}  // namespace psi_slam
