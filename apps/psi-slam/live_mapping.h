// SPDX-License-Identifier: BSD-3-Clause
// What a live run does with each scan, for the program and for its benchmark.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "base/failure_notice.h"
#include "map/exports/live_map_writer.h"
#include "psi_slam/mapping_session.h"
#include "session/settings.h"

namespace psi_slam {

/// Returns the journal of the live run whose results go to `folder`.
inline std::filesystem::path journal_of_live_run(const std::filesystem::path& folder) {
  return folder / "session.journal";
}

/// Maps the scans of a session. Meanwhile it records them in the journal, and writes the map again and again.
class LiveMapping {
 public:
  using Notify = std::function<void(const std::string& sentence)>;

  /// Begins the journal in `folder`, which must exist. `notify` gets a sentence without full stop when the
  /// journal or the map cannot be written, and when they can be again. `show_map`: see LiveMapWriter. Throws
  /// SystemFailure if the journal cannot be created.
  LiveMapping(MappingSession& session, const std::filesystem::path& folder, const Settings& settings,
              Notify notify, LiveMapWriter::ShowMap show_map = {});

  /// Waits for the next scan and maps it. Returns false after the last scan. Throws what
  /// MappingSession::step() throws.
  bool step();

  /// Writes the map as it is drawn now, see LiveMapWriter::write_to().
  void save_map(const std::filesystem::path& yaml_path) { map_.write_to(yaml_path); }

  /// Waits for the loops of the mapped scans, and draws all scans that they moved.
  void catch_up();

 private:
  void draw();

  MappingSession& session_;
  Notify notify_;
  LiveMapWriter map_;
  int postponed_ = 0;  ///< number of scans since the last update of the map
  FailureNotice journal_notice_{"the journal"};
  FailureNotice map_notice_{"the map"};
};

}  // namespace psi_slam
