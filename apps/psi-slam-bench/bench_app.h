// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-bench: how good and how fast the parts of psi-slam are.
//
//     psi-slam-bench match --data DIR [--ini DIR] [--json FILE] [--cases N] [--seed S] [--windows] [-o DIR]
//     psi-slam-bench simulate [--path-m M,M,...] [--people N] [--glass SHARE] [--seed S] [--json FILE] [-o
//     DIR]
//                             [--write-log NAME.clf.gz]
//     psi-slam-bench false-loops --data DIR [--ini DIR] [--logs NAMES] [--shares PERCENTS] [--seeds SEEDS]
//                                [--json FILE] [-o DIR]
//     psi-slam-bench robustness --data DIR [--ini DIR] [--logs NAMES] [--seeds SEEDS] [--json FILE] [-o DIR]
#pragma once

#include <string>
#include <vector>

#include "psi_slam_app.h"

namespace psi_slam {

/// Runs the program with its arguments (without its own name). Returns the exit code: 0 done, 1 failed,
/// 2 wrong usage or input. Never throws.
int run_bench_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept;

}  // namespace psi_slam
