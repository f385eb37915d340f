// SPDX-License-Identifier: BSD-3-Clause
// What a run of the localizer came to, for people and programs.
//
//     localization.csv   a line a scan:
//                        time_s,state,x_m,y_m,theta_rad,response,confidence,fits,ambiguity,note
//     trajectory.tum     the poses of all scans that were tracked
//
// A robot is *found* at the first scan that fits the map. Whether it is localized *at the end* is another
// question, which the last scans answer: those of the last kEnd_s, and kEndScans of them at least.
//
// `ambiguity` and `note`, why a place was not believed, are of searches of the whole map; the pose of a scan
// is empty while the robot is lost.
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
  /// A robot is localized at the end when it is tracked there, and with at least so much confidence.
  static constexpr double kLeastConfidence = 0.5;

  bool interrupted = false;  ///< the log has more scans: its end is where a person ended the run
  std::size_t scans = 0;
  std::size_t tracked = 0;  ///< scans
  std::size_t fitting = 0;  ///< of those, that fit the map
  double duration_s = 0;
  double travelled_m = 0;
  int searches = 0;                     ///< of the whole map
  int times_found = 0;                  ///< by a search; a start that was told is none
  int times_lost = 0;                   ///< after it was tracked
  bool ambiguous = false;               ///< not found or lost at the end: the last search had a rival as good
  double best_response = 0;             ///< of all searches
  std::optional<double> found_after_s;  ///< from the first scan
  std::optional<double> found_after_m;
  mrpt::math::TPose2D map_T_found;  ///< where the robot was then
  std::optional<double> ambiguity;  ///< of the search that found it first
  double median_response = 0;       ///< of the scans that fit
  bool tracked_at_end = false;
  std::optional<double>
      lost_after_s;       ///< where it is lost at the end: its last pose's time, from the first scan
  double confidence = 0;  ///< at the end: the mean of its scans, of which those that do not fit have none
  std::string why_not;    ///< of the last search, where the robot was never found or is lost at the end

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

/// Writes localization.csv and trajectory.tum into a folder that exists. Throws SystemFailure.
void write_localization(const std::vector<LocalizationStep>& steps, const std::filesystem::path& folder);

}  // namespace psi_slam
