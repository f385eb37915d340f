// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-bench: measures accuracy and speed of psi-slam and of its parts. See share/doc/psi-slam-bench.md.
#pragma once

#include <string>
#include <vector>

#include "psi_slam_app.h"

namespace psi_slam {

/// Runs the program with its arguments, without the program's name. Returns the exit code: 0 done, 1 failed,
/// 2 wrong usage or input.
int run_bench_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept;

}  // namespace psi_slam
