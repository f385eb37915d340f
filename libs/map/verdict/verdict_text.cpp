// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "base/number_text.h"
#include "map/verdict/map_verdict.h"
#include "mapping/loop_closure/loop_edit_line.h"
#include "mapping/scan_place.h"

namespace psi_slam {
namespace {

template <class Stretch>
std::string scans_text(const Stretch& stretch) {
  const std::string first = std::to_string(stretch.first_frame);
  return stretch.first_frame == stretch.last_frame
             ? "scan " + first
             : "scans " + first + " to " + std::to_string(stretch.last_frame);
}

std::string time_text(double since_start_s) {
  return minutes_text(std::floor(since_start_s));
}

/// Returns where and when the suspect is: " at (3.1, -2.0) m, 2:42 to 2:45".
std::string whereabouts(const Suspect& suspect) {
  std::string text = " at " + place_text(suspect.at);
  if (!suspect.last_s) return text;
  const std::string last = time_text(*suspect.last_s);
  const bool is_one =
      suspect.kind == Suspect::Kind::kLoop || !suspect.first_s || time_text(*suspect.first_s) == last;
  return text + ", " + (is_one ? last : time_text(*suspect.first_s) + " to " + last);
}

/// Returns which scan the edit names and what it changes; empty if that is unknown.
std::string effect_text(const HotSpot& spot) {
  if (!spot.effect) return {};
  const EditEffect& effect = *spot.effect;
  return " of the scan at " + place_text(effect.scan_at) + ", " + time_text(effect.scan_s) +
         (spot.edit->kind == LoopEdit::Kind::kMatch ? ": if it holds, it moves the map by "
                                                    : ": it moves the map by ") +
         fixed_text(effect.moved_m, 2) + " m at " + place_text(effect.at);
}

const double kLargestError_m = PassCheckOptions().unknown_m;

/// Only errors that scans show have an upper bound, not those that are predicted.
bool is_too_large_to_measure(const HotSpot& spot) {
  return !is_predicted(spot.kind) && spot.error_m && *spot.error_m >= kLargestError_m;
}

std::string unchecked_text(const MapVerdict& verdict) {
  const std::string apart = fixed_text(PassCheckOptions().pass_apart_m, 0);
  std::string text = verdict.checked_share == 0
                         ? "no place was seen twice by scans with " + apart + " m or more of path in between"
                         : "only " + fixed_text(100 * verdict.held_share, 0) +
                               " % of the path lies between places that were seen twice";
  if (verdict.unchecked_stretches.empty()) return text + "; drive on, and return to places seen before";
  const UncheckedStretch& stretch = verdict.unchecked_stretches.front();
  text += "; drive again from " + place_text(stretch.first_at) + " to " + place_text(stretch.last_at) + ", " +
          scans_text(stretch);
  if (stretch.sigma_m)
    text +=
        ", where the standard deviation of the position reaches " + fixed_text(*stretch.sigma_m, 2) + " m";
  return text;
}

/// Clause about the stretches with an open direction; empty without any.
std::string open_text(const std::vector<OpenStretch>& stretches) {
  if (stretches.empty()) return {};
  double length_m = 0;
  std::size_t scans = 0;
  bool has_odometry = false;
  bool lacks_odometry = false;
  for (const OpenStretch& stretch : stretches) {
    length_m += stretch.length_m;
    scans += stretch.last_frame - stretch.first_frame + 1;
    (stretch.has_odometry ? has_odometry : lacks_odometry) = true;
  }
  const char* const source = !lacks_odometry ? "odometry"
                             : has_odometry  ? "odometry or the constant-velocity model"
                                             : "the constant-velocity model";
  const OpenStretch& longest =
      *std::max_element(stretches.begin(), stretches.end(),
                        [](const OpenStretch& a, const OpenStretch& b) { return a.length_m < b.length_m; });
  return "; along bare walls, " + std::string(source) + " alone gives the length of " +
         fixed_text(length_m, 1) + " m of the path (" + counted(scans, "scan") +
         (stretches.size() == 1 ? ", " : ", the longest part: ") + scans_text(longest) + " at " +
         place_text(longest.at) + ")";
}

/// The judgement, without the stretches with an open direction.
std::string judgement(const MapVerdict& verdict) {
  if (verdict.state == MapState::kGood)
    return "the map is good: walls of different passes differ by at most " +
           fixed_text(verdict.wall_thickness_m, 2) + " m at 90 % of the places, and " +
           fixed_text(100 * verdict.checked_share, 0) + " % of the path is checked by a second pass";
  if (verdict.state == MapState::kUnchecked) return "the map is unchecked: " + unchecked_text(verdict);
  const HotSpot& worst = verdict.hot_spots.front();
  if (worst.kind == HotSpot::Kind::kUnplacedRun)
    return "the map is broken: a run was never placed; suspect: " + text_of(worst.suspect);
  const std::string text = hot_spot_text(worst);
  const bool is_worst = worst.error_m.value_or(0) >= verdict.largest_error_m;
  const std::string the_worst = is_worst ? "the worst: " : "the worst that scans show: ";
  if (verdict.state == MapState::kBroken)
    return "the map is broken: the estimated mean error is " + fixed_text(verdict.error_m, 2) + " m, " +
           the_worst + text;
  const std::string thick = verdict.wall_thickness_m <= ScanComparisonOptions().margin_m
                                ? ""
                                : "the map is not good: walls of different passes differ by " +
                                      fixed_text(verdict.wall_thickness_m, 2) +
                                      " m or more at 10 % of the places; ";
  const std::size_t places = verdict.hot_spots.size() + verdict.more_hot_spots;
  if (places == 1) return thick + "check this place: " + text;
  return thick + "check " + counted(places, "place") + " of the map, " + the_worst + text;
}

}  // namespace

bool is_predicted(HotSpot::Kind kind) {
  return kind == HotSpot::Kind::kUncertain || kind == HotSpot::Kind::kOpenDirection ||
         kind == HotSpot::Kind::kUnmatched;
}

std::string text_of(HotSpot::Kind kind) {
  constexpr std::array<const char*, 10> kTexts{
      "doubled wall",    "wall seen through", "runs disagree",  "scans do not fit", "loop in conflict",
      "unmatched scans", "unplaced run",      "gap in the log", "uncertain place",  "open direction"};
  return kTexts[static_cast<std::size_t>(kind)];
}

std::string text_of(MapState state) {
  constexpr std::array<const char*, 4> kTexts{"good", "unchecked", "check these places", "broken"};
  return kTexts[static_cast<std::size_t>(state)];
}

std::string text_of(const Suspect& suspect) {
  if (suspect.kind == Suspect::Kind::kLoop)
    return "the loop of scan " + std::to_string(suspect.last_frame) + " with local map " +
           std::to_string(suspect.local_map) + whereabouts(suspect);
  const std::string scans = scans_text(suspect) + whereabouts(suspect);
  switch (suspect.kind) {
    case Suspect::Kind::kUnmatched:
      return scans + ", which matched no local map";
    case Suspect::Kind::kLost:
      return scans + ", where the place of the robot was lost";
    case Suspect::Kind::kUnplaced:
      return scans + ", where the place of the robot was lost and was never found again";
    case Suspect::Kind::kGap:
      return scans + ", before which the log has a gap";
    case Suspect::Kind::kDrift:
      return scans + ", where loops hold the map too weakly";
    case Suspect::Kind::kOpen:
      return scans + ", which saw only walls along one direction and have no odometry";
    case Suspect::Kind::kLoop:
    case Suspect::Kind::kStretch:
      break;
  }
  return scans + ", where the map of the second pass departs from the first";
}

std::string verdict_sentence(const MapVerdict& verdict) {
  const std::string changes = text_of(verdict.changes);
  return judgement(verdict) + open_text(verdict.open_stretches) + (changes.empty() ? "" : "; " + changes);
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
  if (suspect.kind == Suspect::Kind::kOpen)
    return "record odometry, or put objects along the walls and map again";
  if (spot.edit) return "make the edit \"" + edit_line(spot) + '"' + effect_text(spot);
  if (!suspect.searched_loops) return "set loop_closure.enabled=true";
  const std::string again = "record the path near " + place_text(suspect.at) + " again, ";
  const bool is_gap = suspect.kind == Suspect::Kind::kUnmatched || suspect.kind == Suspect::Kind::kGap;
  return (suspect.kind == Suspect::Kind::kLoop ? "look at this loop in psi-slam-gui"
          : is_gap                             ? again + "slowly and without a gap"
                                               : again + "and from there to a place seen before") +
         (spot.edits_tried ? "; no edit of one loop was found that mends the map" : "");
}

}  // namespace psi_slam
