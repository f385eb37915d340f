// SPDX-License-Identifier: BSD-3-Clause
// A sweep's workers as the ranks of an MPI job. Each run has a process of its own, so that one that crashes
// takes no rank with it.
#pragma once

#include "mpi_ranks.h"
#include "batch/sweep.h"

namespace psi_slam {

/// For rank 0; where it is alone, it does the work itself. `world` outlives what is returned.
SweepWorkers mpi_workers(const MpiWorld& world);

/// For the other ranks: makes a run of a sweep.
std::optional<std::string> make_sweep_run(const std::string& order, const std::function<bool()>& stop);

}  // namespace psi_slam
