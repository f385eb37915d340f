// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/edit_advice.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "logs/frames/pose_operations.h"
#include "mapping/scan_place.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMostMatches = 3;  // that are tried for one place
constexpr std::size_t kMostTrials = 12;  // of different edits for one map

template <class Candidate>
bool has_loop_of(const std::vector<Candidate>& candidates, const LoopEdit& edit) {
  return std::any_of(candidates.begin(), candidates.end(),
                     [&](const Candidate& one) { return same_loop(one.edit, edit); });
}

}  // namespace

EditAdvice::EditAdvice(const MappingResult& result, const std::vector<MapView>& views,
                       const std::vector<PassCheck>& checks, const VerdictOptions& options)
    : result_(result), views_(views), checks_(checks), options_(options) {}

void EditAdvice::add_to(HotSpot& spot) {
  const Suspect& suspect = spot.suspect;
  if (suspect.kind == Suspect::Kind::kDrift || suspect.kind == Suspect::Kind::kOpen) return;
  if (suspect.kind == Suspect::Kind::kLoop) {
    choose({{{LoopEdit::Kind::kDelete, suspect.last_frame, suspect.local_map},
             nullptr,
             &result_.loops[suspect.loop]}},
           spot);
    return;
  }
  if (!suspect.searched_loops) return;
  choose(forces_across(suspect), spot);
  if (!spot.edit) choose(matches_across(spot), spot);
}

/// Returns the outlier loops by hand across a suspect: of each pair, the newest record, which is the one that
/// an edit forces.
std::vector<EditAdvice::Candidate> EditAdvice::forces_across(const Suspect& suspect) const {
  std::vector<Candidate> newest;
  for (auto loop = result_.loops.rbegin(); loop != result_.loops.rend(); ++loop) {
    const LoopEdit edit{LoopEdit::Kind::kForce, loop->frame, loop->local_map};
    if (found_nothing(*loop) || has_loop_of(newest, edit)) continue;
    if (loop->frame >= suspect.last_frame && result_.node_frames[loop->reference] <= suspect.first_frame)
      newest.push_back({edit, nullptr, &*loop});
  }
  newest.erase(
      std::remove_if(newest.begin(), newest.end(),
                     [](const Candidate& one) { return !one.loop->by_hand || !is_outlier(*one.loop); }),
      newest.end());
  return newest;
}

/// Adds the candidate that leaves the least disagreement, if any mends the place.
void EditAdvice::choose(const std::vector<Candidate>& candidates, HotSpot& spot) {
  double least_m = std::numeric_limits<double>::infinity();
  for (const Candidate& one : candidates) {
    const TriedEdit* const tried = this->tried(one, spot.suspect);
    spot.edits_tried = spot.edits_tried || tried != nullptr;
    const std::optional<double> left_m = tried ? disagreement_left_m(*tried, spot) : std::nullopt;
    if (!left_m || *left_m >= least_m) continue;
    least_m = *left_m;
    spot.edit = one.edit;
    spot.effect = tried->effect;
  }
  if (!spot.edit) return;
  const FrameRecord& scan = result_.frames[spot.edit->frame];
  spot.effect->scan_s = time_in_run_s(result_.frames, result_.later_run_frames, spot.edit->frame);
  spot.effect->scan_at = {scan.map_T_robot.x, scan.map_T_robot.y};
}

/// Returns the map after an edit; null if it cannot be tried.
const TriedEdit* EditAdvice::tried(const Candidate& candidate, const Suspect& suspect) {
  const LoopEdit& edit = candidate.edit;
  const auto key = std::make_tuple(edit.kind, edit.frame, edit.local_map, suspect.first_frame);
  auto found = tried_.find(key);
  if (found == tried_.end()) {
    if (tried_.size() == kMostTrials) return nullptr;
    if (!trial_) trial_.emplace(result_, views_, checks_, options_.passes);
    std::optional<TriedEdit> map;
    if (edit.kind == LoopEdit::Kind::kDelete)
      map = trial_->without_loop(*candidate.loop);
    else if (edit.kind == LoopEdit::Kind::kForce)
      map = trial_->with_loop(*candidate.loop);
    else {
      const MapView& other = views_[candidate.check->other];
      const MapView& view = views_[candidate.check->view];
      if (const auto pose = matched_pose(view, other, options_.passes))
        map = trial_->with_match({other.node, view.node, between(other.map_T_robot, *pose)},
                                 {suspect.first_frame, suspect.last_frame + 1});
    }
    found = tried_.emplace(key, std::move(map)).first;
  }
  return found->second ? &*found->second : nullptr;
}

/// Whether a check is among the scans that see the fault of a hot spot, or else across the suspect. If it is
/// displaced, it shows the fault.
bool EditAdvice::concerns(const PassCheck& check, const HotSpot& spot) const {
  const std::size_t frame = views_[check.view].frame;
  if (spot.seen_by.end > 0) return frame >= spot.seen_by.begin && frame < spot.seen_by.end;
  const auto [first, last] = std::minmax({frame, views_[check.other].frame});
  return first <= spot.suspect.first_frame && last >= spot.suspect.last_frame;
}

/// Returns the sum of the errors that an edit leaves at a hot spot; empty if it does not mend it.
std::optional<double> EditAdvice::disagreement_left_m(const TriedEdit& tried, const HotSpot& spot) const {
  double before_m = 0;
  double after_m = 0;
  std::size_t worse = 0;
  for (std::size_t i = 0; i < checks_.size(); ++i) {
    const double error_m = checks_[i].error_m;
    const bool is_displaced = error_m >= options_.spot_error_m;
    const std::optional<double>& then_m = tried.errors_m[i];
    const bool concerned = concerns(checks_[i], spot);
    const bool fitted = !is_displaced && !checks_[i].scene_changed;
    if (!concerned && (then_m ? *then_m >= error_m + options_.spot_error_m : fitted)) ++worse;
    if (!is_displaced || !concerned) continue;
    before_m += error_m;
    after_m += then_m.value_or(error_m);
  }
  if (worse >= options_.least_checks || before_m <= 0 || 2 * after_m > before_m) return std::nullopt;
  return after_m;
}

/// Whether the map has the loop already, or had a match by hand of it.
bool EditAdvice::is_made(const LoopEdit& match) const {
  return std::any_of(result_.loops.begin(), result_.loops.end(), [&](const LoopRecord& loop) {
    return same_loop(loop, match) && (loop.by_hand || loop.state == LoopState::kAccepted);
  });
}

/// Returns matches of a scan after the suspect with a local map before it: of the displaced scans, those with
/// the most common points.
std::vector<EditAdvice::Candidate> EditAdvice::matches_across(const HotSpot& spot) const {
  std::vector<Candidate> matches;
  for (const PassCheck& check : checks_) {
    if (check.error_m < options_.spot_error_m || !concerns(check, spot)) continue;
    const auto [first, last] = std::minmax({check.view, check.other});
    if (views_[first].frame > spot.suspect.first_frame || views_[last].frame < spot.suspect.last_frame)
      continue;
    const std::optional<std::size_t> local_map = local_map_around(first, spot.suspect.first_frame);
    if (!local_map) continue;
    const LoopEdit edit{LoopEdit::Kind::kMatch, views_[last].frame, *local_map};
    if (!is_made(edit)) matches.push_back({edit, &check});
  }
  std::stable_sort(matches.begin(), matches.end(), [](const Candidate& a, const Candidate& b) {
    return std::pair(a.check->fits_if_moved, a.check->error_m) >
           std::pair(b.check->fits_if_moved, b.check->error_m);
  });
  std::vector<Candidate> chosen;
  for (const Candidate& one : matches)
    if (chosen.size() < kMostMatches && !has_loop_of(chosen, one.edit)) chosen.push_back(one);
  return chosen;
}

/// The local map with a view nearest to its middle, among those without scans after last_frame.
std::optional<std::size_t> EditAdvice::local_map_around(std::size_t view, std::size_t last_frame) const {
  const std::size_t node = views_[view].node;
  const auto off_middle = [&](const LocalMapRecord& map) {
    return std::max(node - map.first_node, map.last_node - node);
  };
  std::optional<std::size_t> nearest;
  for (std::size_t i = 0; i < result_.local_maps.size(); ++i) {
    const LocalMapRecord& map = result_.local_maps[i];
    if (map.first_node > node || map.last_node < node || result_.node_frames[map.last_node] > last_frame)
      continue;
    if (!nearest || off_middle(map) < off_middle(result_.local_maps[*nearest])) nearest = i;
  }
  return nearest;
}

}  // namespace psi_slam
