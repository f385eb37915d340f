// SPDX-License-Identifier: BSD-3-Clause
#include "site_run.h"

#include <filesystem>
#include <optional>
#include <ostream>
#include <string>
#include <system_error>
#include <utility>

#include "session/site_folder.h"

namespace psi_slam {
namespace {

/// Returns whether the prior map of the run is the newest map of the site. A site may begin with any run.
bool continues_newest(const SiteFolder& site, const std::string& prior_map) {
  const auto newest = site.newest_map();
  std::error_code ignored;
  return !newest || std::filesystem::equivalent(*newest, prior_map, ignored);
}

/// Returns why a run is not part of its site, as a clause; empty if it is.
std::string objection(const SiteFolder& site, const MappingSession& session, const RunInfo& info,
                      const RunSummary& summary) {
  if (session.result().interrupted) return "it was interrupted";
  if (summary.verdict && summary.verdict->state == MapState::kBroken) return "its own map is broken";
  if (!continues_newest(site, info.settings.at("prior.map")))
    return "its prior.map is not the newest map of the site: another run has been added since this one "
           "began, or its session was recorded without the site";
  if (site.runs().empty()) return "";
  if (!summary.prior || !summary.prior->is_accepted)
    return "it could not be aligned with the newest map of the site";
  if (!summary.prior->is_extended)
    return "the newest map could not be extended: the map exceeds map.max_cells and has larger cells, or the "
           "session says prior.extend=false";
  return "";
}

}  // namespace

void continue_site(CommandLine& line, const std::string& name) {
  if (line.site.empty()) return;
  const SiteFolder site(line.site);
  line.output = site.folder_of_next(name).string();
  const auto newest = site.newest_map();
  if (!newest || !line.resume.empty()) return;  // a session states its prior map
  line.settings.push_back("prior.map=" + newest->string());
  line.settings.emplace_back("prior.extend=true");
}

bool add_to_site(const CommandLine& line, const MappingSession& session, const RunSummary& summary,
                 const OutputFolder& folder, const Streams& streams) {
  if (line.site.empty()) return true;
  SiteFolder site(line.site);
  const RunInfo info = session.run_info();
  const std::string why = objection(site, session, info, summary);
  if (!why.empty()) {
    streams.err << "psi-slam: this run is not part of the site " << line.site << ", because " << why
                << ". Its results are in " << folder.path().string()
                << ". Map its log, or trajectory.carmen in that folder, again with --continue, or continue "
                   "with the next run\n";
    return false;
  }
  SiteRun run;
  run.folder = folder.path().filename().string();
  run.log = info.log_name;
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
