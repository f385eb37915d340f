// SPDX-License-Identifier: BSD-3-Clause
// Summary of the localization of one run, as text, JSON and CSV.
//
//     localization.csv   a line for each scan:
//                        time_s,state,x_m,y_m,theta_rad,response,confidence,fits,ambiguity,note
//     trajectory.tum     the poses of all scans with a tracked robot
//
// The robot is *found* at the first scan that fits the map. The scans of the last kEnd_s seconds, but at
// least the last kEndScans scans, decide whether it is localized *at the end*.
//
// `ambiguity` and `note` (why a place was rejected) are filled for searches of the whole map. The pose is
// empty while the robot is lost.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/localizer.h"

namespace psi_slam {

struct LocalizationSummary {
  static constexpr double kEnd_s = 5.0;
  static constexpr std::size_t kEndScans = 5;
  /// Smallest confidence at the end of a robot that counts as localized.
  static constexpr double kLeastConfidence = 0.5;

  bool interrupted = false;  ///< the user stopped the localization before the end of the log
  std::size_t scans = 0;     ///< number of scans
  std::size_t tracked = 0;   ///< number of scans with a tracked robot
  std::size_t fitting = 0;   ///< number of scans that fit the map
  double duration_s = 0;
  double travelled_m = 0;
  int searches = 0;          ///< number of searches of the whole map
  int times_found = 0;       ///< how often a search found the robot; a given start does not count
  int times_lost = 0;        ///< how often the robot was lost after it had been tracked
  bool ambiguous = false;    ///< not found or lost, and another place fitted equally well in the last search
  double best_response = 0;  ///< largest response of all searches
  std::optional<double> found_after_s;  ///< time from the first scan to the first scan that fits
  std::optional<double> found_after_m;  ///< travel from the first scan to the first scan that fits
  mrpt::math::TPose2D map_T_found;      ///< pose of the first scan that fits
  std::optional<double> ambiguity;      ///< ambiguity of the first search that found the robot
  double median_response = 0;           ///< median response of the scans that fit the map
  bool tracked_at_end = false;
  /// Time from the first scan to the last scan with a tracked robot, if the robot is lost at the end.
  std::optional<double> lost_after_s;
  double confidence = 0;  ///< mean confidence of the scans at the end, where misfits count as 0
  std::string why_not;    ///< objection of the last search, if the robot was not found or is lost at the end

  bool found() const { return fitting > 0; }
  bool localized_at_end() const { return tracked_at_end && confidence >= kLeastConfidence; }
  double tracked_share() const {
    return scans == 0 ? 0 : static_cast<double>(tracked) / static_cast<double>(scans);
  }
};

LocalizationSummary summarize(const std::vector<LocalizationStep>& steps);

/// Returns the summary as a few lines of text for people.
std::string localization_text(const LocalizationSummary& summary);
std::string localization_json(const LocalizationSummary& summary);
std::string localization_csv(const std::vector<LocalizationStep>& steps);

/// Writes localization.csv and trajectory.tum to an existing folder. Throws SystemFailure if writing fails.
void write_localization(const std::vector<LocalizationStep>& steps, const std::filesystem::path& folder);

}  // namespace psi_slam
