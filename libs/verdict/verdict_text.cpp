// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "base/number_text.h"
#include "psi_slam/loop_record.h"
#include "verdict/map_verdict.h"

namespace psi_slam {
namespace {

std::string place_text(const mrpt::math::TPoint2D& at) {
  return "(" + fixed_text(at.x, 1) + ", " + fixed_text(at.y, 1) + ") m";
}

std::string scans_text(const Suspect& suspect) {
  const std::string first = std::to_string(suspect.first_frame);
  return suspect.first_frame == suspect.last_frame
             ? "scan " + first
             : "scans " + first + " to " + std::to_string(suspect.last_frame);
}

}  // namespace

std::string text_of(HotSpot::Kind kind) {
  constexpr std::array<const char*, 9> kTexts{"doubled wall",     "wall seen through", "runs disagree",
                                              "scans do not fit", "loop in conflict",  "unmatched scans",
                                              "unplaced run",     "gap in the log",    "uncertain place"};
  return kTexts[static_cast<std::size_t>(kind)];
}

std::string text_of(MapState state) {
  constexpr std::array<const char*, 3> kTexts{"good", "check these places", "broken"};
  return kTexts[static_cast<std::size_t>(state)];
}

std::string text_of(const Suspect& suspect) {
  switch (suspect.kind) {
    case Suspect::Kind::kLoop:
      return "the loop of scan " + std::to_string(suspect.last_frame) + " with local map " +
             std::to_string(suspect.local_map);
    case Suspect::Kind::kUnmatched:
      return scans_text(suspect) + ", which matched no local map";
    case Suspect::Kind::kLost:
      return scans_text(suspect) + ", where the place of the robot was lost";
    case Suspect::Kind::kUnplaced:
      return scans_text(suspect) + ", where the place of the robot was lost and was never found again";
    case Suspect::Kind::kGap:
      return scans_text(suspect) + ", before which the log has a gap";
    case Suspect::Kind::kDrift:
      return scans_text(suspect) + ", where loops hold the map too weakly";
    case Suspect::Kind::kStretch:
      break;
  }
  return scans_text(suspect) + ", where the map of the second pass departs from the first";
}

std::string verdict_sentence(const MapVerdict& verdict) {
  const std::string checked =
      fixed_text(100 * verdict.checked_share, 0) + " % of the path is checked by a second pass";
  if (verdict.state == MapState::kGood) {
    if (verdict.checked_share == 0)
      return "the map shows no fault, but no place was seen by two passes that could be compared";
    return "the map is good: walls of different passes differ by at most " +
           fixed_text(verdict.wall_thickness_m, 2) + " m at 90 % of the places, and " + checked;
  }
  const HotSpot& worst = verdict.hot_spots.front();
  if (worst.kind == HotSpot::Kind::kUnplacedRun)
    return "the map is broken: a run was never placed; suspect: " + text_of(worst.suspect);
  const std::string text = hot_spot_text(worst);
  if (verdict.state == MapState::kBroken)
    return "the map is broken: the estimated mean error is " + fixed_text(verdict.error_m, 2) +
           " m, the worst: " + text;
  const std::size_t places = verdict.hot_spots.size() + verdict.more_hot_spots;
  if (places == 1) return "check this place: " + text;
  return "check " + counted(places, "place") + " of the map, the worst: " + text;
}

std::string hot_spot_text(const HotSpot& spot) {
  std::string text = text_of(spot.kind) + " at " + place_text(spot.at);
  if (spot.error_m) text += ", error about " + fixed_text(*spot.error_m, 2) + " m";
  return text + "; suspect: " + text_of(spot.suspect);
}

std::string advice_text(const HotSpot& spot) {
  const Suspect& suspect = spot.suspect;
  switch (suspect.kind) {
    case Suspect::Kind::kLoop: {
      LoopEdit edit;
      edit.frame = suspect.last_frame;
      edit.local_map = suspect.local_map;
      return text_of(edit);
    }
    case Suspect::Kind::kUnmatched:
      return "raise front_end.max_wide_window_m, or match a scan after scan " +
             std::to_string(suspect.last_frame) + " with a local map before scan " +
             std::to_string(suspect.first_frame) + " by hand";
    case Suspect::Kind::kLost:
    case Suspect::Kind::kUnplaced:
    case Suspect::Kind::kGap:
      return "match a scan after scan " + std::to_string(suspect.last_frame) +
             " with a local map of the rest of the map by hand";
    case Suspect::Kind::kDrift:
    case Suspect::Kind::kStretch:
      break;
  }
  const std::string setting =
      suspect.searched_loops ? "raise loop_closure.wide_searches" : "set loop_closure.enabled=true";
  return setting + ", or match a scan after scan " + std::to_string(suspect.last_frame) +
         " with a local map before scan " + std::to_string(suspect.first_frame) + " by hand";
}

}  // namespace psi_slam
