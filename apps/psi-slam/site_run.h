// SPDX-License-Identifier: BSD-3-Clause
// Runs that continue a site: psi-slam --continue SITE.
#pragma once

#include <string>

#include "command_line.h"
#include "map/exports/run_summary.h"
#include "map/report/output_folder.h"
#include "psi_slam/mapping_session.h"

namespace psi_slam {

/// Chooses the folder for the results and the prior map of a run with --continue, in place of settings of the
/// user. A resumed session keeps its own prior map. Does nothing without --continue. `name` is that of the
/// log without extension. Throws UserError if the site is damaged.
void continue_site(CommandLine& line, const std::string& name);

/// Adds a run with --continue to its site, and prints what it changed. Returns false and prints why if the
/// run is not part of the site, for example because it does not fit the newest map. Returns true without
/// --continue.
bool add_to_site(const CommandLine& line, const MappingSession& session, const RunSummary& summary,
                 const OutputFolder& folder, const Streams& streams);

}  // namespace psi_slam
