// SPDX-License-Identifier: BSD-3-Clause
#include "live_mapping.h"

#include <utility>

namespace psi_slam {

LiveMapping::LiveMapping(MappingSession& session, const std::filesystem::path& folder,
                         const Settings& settings, Notify notify)
    : session_(session), notify_(std::move(notify)), map_(folder, settings.map, settings.live.map_period_s) {
  session_.start_journal(journal_of_live_run(folder));
}

bool LiveMapping::step() {
  if (!session_.step()) return false;
  map_.update(session_.mapper(), [&] { return session_.scan_waits(); });
  if (const auto news = journal_notice_.news(session_.journal_failure())) notify_(*news);
  if (const auto news = map_notice_.news(map_.failure())) notify_(*news);
  return true;
}

void LiveMapping::catch_up() {
  session_.mapper().wait();
  map_.settle(session_.mapper());
}

}  // namespace psi_slam
