// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>

#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Compares the headings of a gyroscope in the frames `of_log` with the mapped path, as the front end does
/// (see GyroscopeModel). Returns a sentence with the remedy if the gyroscope was mostly not credible; empty
/// if it was, or if fewer than 20 scans tell.
std::optional<std::string> rejected_gyroscope(const MappingResult& result, const FrameSpan& of_log);

}  // namespace psi_slam
