// SPDX-License-Identifier: BSD-3-Clause
// Result of a run of the localizer, as text, JSON and CSV.
//
//     localization.csv   a line for each scan:
//                        time_s,state,x_m,y_m,theta_rad,response,confidence,fits,ambiguity,note
//     trajectory.tum     the poses of all scans that were tracked
//
// A robot is *found* at the first scan that fits the map. Whether it is localized *at the end* depends on the
// scans of the last kEnd_s seconds, at least kEndScans of them.
//
// `ambiguity` and `note` (why a place was not believed) belong to searches of the whole map. The pose is
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
  /// Least confidence of a robot that is localized at the end.
  static constexpr double kLeastConfidence = 0.5;

  bool interrupted = false;  ///< the user ended the run before the end of the log
  std::size_t scans = 0;
  std::size_t tracked = 0;  ///< scans
  std::size_t fitting = 0;  ///< scans that fit the map
  double duration_s = 0;
  double travelled_m = 0;
  int searches = 0;          ///< of the whole map
  int times_found = 0;       ///< by a search, not by a known start
  int times_lost = 0;        ///< while being tracked
  bool ambiguous = false;    ///< lost at the end, and another place fitted as well in the last search
  double best_response = 0;  ///< of all searches
  std::optional<double> found_after_s;  ///< from the first scan
  std::optional<double> found_after_m;
  mrpt::math::TPose2D map_T_found;  ///< first pose that was found
  std::optional<double> ambiguity;  ///< of the first search that found the robot
  double median_response = 0;       ///< of the scans that fit
  bool tracked_at_end = false;
  /// Time of the last pose, from the first scan, if the robot is lost at the end.
  std::optional<double> lost_after_s;
  double confidence = 0;  ///< mean of the scans at the end; 0 for those that do not fit
  std::string why_not;    ///< objection of the last search, if the robot is not found or lost at the end

  bool found() const { return fitting > 0; }
  bool localized_at_end() const { return tracked_at_end && confidence >= kLeastConfidence; }
  double tracked_share() const {
    return scans == 0 ? 0 : static_cast<double>(tracked) / static_cast<double>(scans);
  }
};

LocalizationSummary summarize(const std::vector<LocalizationStep>& steps);

/// A few lines for people.
std::string localization_text(const LocalizationSummary& summary);
std::string localization_json(const LocalizationSummary& summary);
std::string localization_csv(const std::vector<LocalizationStep>& steps);

/// Writes localization.csv and trajectory.tum into an existing folder. Throws SystemFailure.
void write_localization(const std::vector<LocalizationStep>& steps, const std::filesystem::path& folder);

}  // namespace psi_slam
