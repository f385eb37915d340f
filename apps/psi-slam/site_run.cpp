// SPDX-License-Identifier: BSD-3-Clause
#include "site_run.h"

#include <optional>
#include <ostream>

#include "session/site_folder.h"

namespace psi_slam {
namespace {

/// Returns why a run is not part of its site, as a clause; empty if it is.
std::string objection(const RunSummary& summary, bool is_first) {
  if (!is_first && !(summary.prior && summary.prior->is_accepted))
    return "it could not be aligned with the newest map of the site";
  if (summary.verdict && summary.verdict->state == MapState::kBroken) return "its own map is broken";
  return "";
}

}  // namespace

void continue_site(CommandLine& line, const std::string& name) {
  if (line.site.empty()) return;
  const SiteFolder site(line.site);
  line.output = site.folder_of_next(name).string();
  const auto newest = site.newest_map();
  if (!newest) return;
  line.settings.push_back("prior.map=" + newest->string());
  line.settings.emplace_back("prior.extend=true");
}

bool add_to_site(const CommandLine& line, const MappingSession& session, const RunSummary& summary,
                 const OutputFolder& folder, const Streams& streams) {
  if (line.site.empty()) return true;
  SiteFolder site(line.site);
  const std::string why = objection(summary, site.runs().empty());
  if (!why.empty()) {
    streams.err << "psi-slam: this run is not part of the site " << line.site << ", because " << why
                << ". Its results are in " << folder.path().string()
                << ". The next run continues from the map before it\n";
    return false;
  }
  SiteRun run;
  run.folder = folder.path().filename().string();
  run.log = session.run_info().log_name;
  run.first_time_us = summary.log.first_time_us;
  run.path_length_m = summary.path_length_m;
  const SiteRun& added = site.add(std::move(run));
  if (line.json || line.quiet) return true;
  const std::string changes = changes_text(added.changes);
  streams.out << "Site " << line.site << ", run " << site.runs().size() << ": "
              << (site.runs().size() == 1 ? "the map of the site begins"
                  : changes.empty()       ? "no wall of at least 0.5 m has changed"
                                          : changes)
              << ".\n";
  return true;
}

}  // namespace psi_slam
