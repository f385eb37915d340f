// SPDX-License-Identifier: BSD-3-Clause
#include "live_mapping.h"

#include <utility>

namespace psi_slam {

LiveMapping::LiveMapping(MappingSession& session, const std::filesystem::path& folder,
                         const Settings& settings, Notify notify, LiveMapWriter::ShowMap show_map)
    : session_(session),
      notify_(std::move(notify)),
      map_(folder, settings.map, settings.live.map_period_s, std::move(show_map)) {
  session_.start_journal(journal_of_live_run(folder));
}

bool LiveMapping::step() {
  if (!session_.step()) return false;
  draw();
  if (const auto news = journal_notice_.news(session_.journal_failure())) notify_(*news);
  if (const auto news = map_notice_.news(map_.failure())) notify_(*news);
  return true;
}

/// Updates the map, or postpones that while scans wait: after a pause some robots deliver many at once.
void LiveMapping::draw() {
  constexpr int kMostPostponed = 16;
  const auto scan_waits = [&] { return session_.scan_waits(); };
  if (postponed_ < kMostPostponed && scan_waits()) {
    ++postponed_;
    return;
  }
  postponed_ = 0;
  map_.update(session_.mapper(), scan_waits);
}

void LiveMapping::catch_up() {
  session_.mapper().wait();
  map_.settle(session_.mapper());
}

}  // namespace psi_slam
