// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "mrpt/decider_catalogue.h"

namespace psi_slam {

/// A heading, and what each of them is and needs, for a terminal.
std::string decider_listing(const std::string& heading, const std::vector<DeciderDescription>& deciders);

}  // namespace psi_slam
