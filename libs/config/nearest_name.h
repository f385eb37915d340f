// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace psi_slam {

/// The letters to insert, delete, replace or swap with their neighbour to make `b` of `a`, upper and lower
/// case being the same (optimal string alignment distance).
std::size_t edit_distance(std::string_view a, std::string_view b);

/// The name that was probably meant by a misspelt one: the first of those with the smallest edit distance, if
/// it differs in at most one letter and one more for every four.
std::optional<std::string> nearest_name(std::string_view misspelt, const std::vector<std::string>& names);

}  // namespace psi_slam
