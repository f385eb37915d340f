// SPDX-License-Identifier: BSD-3-Clause
// A sweep's workers as the ranks of an MPI job: rank 0 hands out the runs, the others make them, each in a
// process of its own, so that a run that crashes takes no rank with it.
#pragma once

#include "mpi_messages.h"
#include "psi_slam/batch/sweep.h"

namespace psi_slam {

/// For rank 0; where it is alone, it does the work itself. `world` outlives what is returned.
SweepWorkers mpi_workers(const MpiWorld& world);

/// For the other ranks: makes the runs that rank 0 hands out, until that dismisses it.
void work_for_rank_0(const MpiWorld& world);

/// For rank 0, at the end.
void dismiss_workers(const MpiWorld& world);

}  // namespace psi_slam
