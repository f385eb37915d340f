// SPDX-License-Identifier: BSD-3-Clause
#include <array>

#include "base/number_text.h"
#include "loop_closure/loop_edit_line.h"
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

const double kLargestError_m = PassCheckOptions().unknown_m;

/// Only errors that scans show have an upper bound, not those that are predicted.
bool is_too_large_to_measure(const HotSpot& spot) {
  const bool is_predicted = spot.kind == HotSpot::Kind::kUncertain || spot.kind == HotSpot::Kind::kUnmatched;
  return !is_predicted && spot.error_m && *spot.error_m >= kLargestError_m;
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

std::string error_text(const HotSpot& spot) {
  if (!spot.error_m) return {};
  return is_too_large_to_measure(spot) ? fixed_text(kLargestError_m, 0) + " m or more"
                                       : fixed_text(*spot.error_m, 2) + " m";
}

std::string edit_line(const HotSpot& spot) {
  if (!spot.edit) return {};
  // A forced loop needs its match first.
  return loop_edit_line(*spot.edit) + (spot.edit->kind == LoopEdit::Kind::kForce ? " after=end" : "");
}

std::string hot_spot_text(const HotSpot& spot) {
  std::string text = text_of(spot.kind) + " at " + place_text(spot.at);
  if (spot.error_m)
    text += (is_too_large_to_measure(spot) ? ", error of " : ", error about ") + error_text(spot);
  text += "; suspect";
  if (spot.places_of_suspect > 1) text += " of " + counted(spot.places_of_suspect, "place");
  return text + ": " + text_of(spot.suspect);
}

std::string advice_text(const HotSpot& spot) {
  const Suspect& suspect = spot.suspect;
  const bool is_apart = suspect.kind == Suspect::Kind::kLost || suspect.kind == Suspect::Kind::kUnplaced;
  std::string edit = "match a scan after scan " + std::to_string(suspect.last_frame) +
                     (is_apart ? " with a local map of the rest of the map"
                               : " with a local map before scan " + std::to_string(suspect.first_frame)) +
                     " by hand";
  if (spot.edit) edit = "make the edit \"" + edit_line(spot) + '"';
  std::string setting;
  if (suspect.kind == Suspect::Kind::kUnmatched) setting = "raise front_end.max_wide_window_m, or ";
  if (!suspect.searched_loops) return setting + "set loop_closure.enabled=true";
  if (suspect.kind == Suspect::Kind::kDrift || suspect.kind == Suspect::Kind::kStretch)
    setting = "raise loop_closure.wide_searches, or ";
  return setting + edit;
}

}  // namespace psi_slam
