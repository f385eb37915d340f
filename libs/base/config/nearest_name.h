// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

/// Number of letters to insert, delete, replace or swap with a neighbour to change `a` into `b`, ignoring
/// case (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// Returns the name with the smallest edit distance to `misspelt`, the first of several. Empty if this
/// distance is above one plus a quarter of the length of `misspelt`.
std::optional<std::string> nearest_name(std::string_view misspelt, const std::vector<std::string>& names);

}  // namespace psi_slam
