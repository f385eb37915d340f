// SPDX-License-Identifier: BSD-3-Clause
// Keeps track of a robot in a finished map, scan by scan, and finds it where it is lost: at the beginning,
// unless its start is told, and again after it was carried away.
//
// The front end measures its motion, in a frame of the front end's own. While the robot is lost, every metre
// the last scans are looked for in the whole map (GlobalSearch); it is found when several searches from
// different places say the same (LoopConsensus). From then on each scan is matched in a small window around
// where the motion predicts it, until too many in a row do not fit.
#pragma once

#include <optional>

#include "psi_slam/time_stamp.h"
#include "local_maps/front_end.h"
#include "localization/global_search.h"
#include "loop_closure/loop_consensus.h"

namespace psi_slam {

struct LocalizerOptions {
  FrontEndOptions front_end;  ///< that measures the motion
  GlobalSearchOptions search;
  LoopConsensusOptions consensus;
  std::uint64_t seed = 1;

  double search_travel_m = 1.0;  ///< while lost: between one search and the next

  // While tracking.
  double window_m = 0.3;
  double window_rad = radians_from_degrees(6.0L);
  double prior_sigma_m = 0.05;  ///< of the motion's prediction
  double prior_sigma_rad = radians_from_degrees(2.0L);
  double start_window_m = 1.0;  ///< around a start that was told
  double start_window_rad = radians_from_degrees(15.0L);
  double min_response = 0.3;
  double min_observed_share = 0.5;  ///< of a scan's points, in space that the map shows
  double min_agree = 0.6;           ///< of these, on something occupied
  double max_misfit_m = 2.0;        ///< lost when scans have not fitted for so much travel,
  double max_misfit_s = 5.0;        ///< or for so long
};

/// What became of one scan.
struct LocalizationStep {
  enum class State { kLost, kTracking };
  TimeUs time_us = 0;
  State state = State::kLost;
  mrpt::math::TPose2D map_T_robot;  ///< while tracking
  bool fits = false;                ///< the scan fits the map there; false: the motion alone says where it is
  double response = 0;              ///< where it fits
  double confidence = 0;            ///< where it fits: the share of its points that lie on the map's walls
  double moved_m = 0;               ///< since the scan before
  std::optional<FoundPlace> search;  ///< of the whole map, if one was made at this scan
};

class Localizer {
 public:
  Localizer(ReferenceMap map, const LocalizerOptions& options);

  /// Before the first scan: the robot is near there.
  void start_at(const mrpt::math::TPose2D& map_T_robot);

  /// The per-scan step.
  LocalizationStep add(const Frame& frame);

 private:
  bool tracking() const { return map_T_local_.has_value(); }
  void track(const FrontEndStep& motion, LocalizationStep& step);
  PosePrior prior_at(const mrpt::math::TPose2D& map_T_robot) const;
  bool match_near(const FrontEndStep& motion, LocalizationStep& step) const;
  void search(std::size_t frame, LocalizationStep& step);
  void find_again();

  LocalizerOptions options_;
  GlobalSearch search_;
  CorrelativeMatcher matcher_;
  std::optional<FrontEnd> front_end_;
  mrpt::math::TPose2D last_local_T_robot_;
  std::optional<mrpt::math::TPose2D> map_T_local_;  ///< of the front end's frame; none while lost
  bool near_told_start_ = false;                    ///< no scan has fitted since
  double misfit_m_ = 0;                             ///< since the last scan that fitted
  TimeUs fitted_us_ = 0;
  TimeUs now_us_ = 0;

  // While lost.
  KeyframeStore memory_;  ///< of the way since the robot was lost
  LoopConsensus consensus_;
  PoseGraph map_frame_;  ///< its one node is the map: what the places found are seen from
};

}  // namespace psi_slam
