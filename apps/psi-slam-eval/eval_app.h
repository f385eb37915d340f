// SPDX-License-Identifier: BSD-3-Clause
// psi-slam-eval: measures the errors of a trajectory over relations, by the metric of relations_metric.h.
//
//     psi-slam-eval TRAJECTORY RELATIONS [--max-gap S] [--per-relation FILE [--force]] [--json] [--version]
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace psi_slam {

/// Runs the program with its arguments, without the program's name. Prints results to `out` and errors to
/// `err`. Returns the exit code: 0 done, 1 failed, 2 wrong usage or input.
int run_eval_app(const std::vector<std::string>& arguments, std::ostream& out, std::ostream& err) noexcept;

}  // namespace psi_slam
