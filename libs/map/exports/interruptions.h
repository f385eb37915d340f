// SPDX-License-Identifier: BSD-3-Clause
// Interruptions of a log after which the robot was at an unknown place, as text for users.
#pragma once

#include <string>
#include <vector>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Returns one sentence for each interruption of result.interruptions: when it was, and when the robot was
/// found again. Times are minutes and seconds since the first scan of the log. If the robot was never found
/// again, the sentence warns that the map has a separate part.
std::vector<std::string> interruption_texts(const MappingResult& result);

}  // namespace psi_slam
