// SPDX-License-Identifier: BSD-3-Clause
// A site: a building that is mapped again and again. Its folder has a folder of results for each run,
// "0001-monday", and site.json, which lists the runs that are part of the site with the walls that each of
// them changed. "newest" is a link to the last of these runs.
//
// Each run is aligned with the map of the run before and extends it, so the frame of the map never moves, and
// a run costs the same whatever the history. Deleting the folders of the last runs takes the site back to the
// runs before; folders of older runs are not needed. The link is set again when the next run is added.
#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "localization/comparison/wall_changes.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// A run that is part of a site.
struct SiteRun {
  std::string folder;               ///< its folder in that of the site
  std::string log;                  ///< name of the log
  TimeUs first_time_us = 0;         ///< time of its first scan
  double path_length_m = 0;         ///< length of the path of the robot
  std::vector<WallChange> changes;  ///< against the map of the run before, in the frame of the site
};

class SiteFolder {
 public:
  /// Reads the folder of a site; it need not exist. Throws UserError if it is a file, is not empty and has no
  /// site.json, if this file is damaged, or if none of its runs has its folder.
  explicit SiteFolder(std::filesystem::path path);

  /// The runs of the site in their order, up to the last whose folder exists.
  const std::vector<SiteRun>& runs() const { return runs_; }

  /// Returns the file of the newest map; empty before the first run. Throws UserError if the newest run has
  /// none.
  std::optional<std::filesystem::path> newest_map() const;

  /// Returns the folder for the results of a further run: a number and the name of the run.
  std::filesystem::path folder_of_next(const std::string& name) const;

  /// Adds a run whose results are in its folder. Computes its changes. Throws SystemFailure if site.json
  /// cannot be written.
  const SiteRun& add(SiteRun run);

 private:
  std::filesystem::path map_of(const SiteRun& run) const;

  std::filesystem::path path_;
  std::vector<SiteRun> runs_;
  int last_listed_ = 0;  ///< largest number of a listed run, whether or not its folder exists
};

/// Returns what a run changed: "2 walls are new (3.1 m), 1 wall is gone (0.8 m)". Empty without changes.
std::string changes_text(const std::vector<WallChange>& changes);

}  // namespace psi_slam
