// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/maps/COccupancyGridMap2D.h>

#include "map/exports/run_summary.h"

namespace psi_slam {

/// The finished map as MappingSession::export_to() writes it.
struct DrawnMap {
  mrpt::maps::COccupancyGridMap2D::Ptr grid;  ///< the drawn map, with its edits
  RunSummary summary;                         ///< figures of the run, with the verdict
};

}  // namespace psi_slam
