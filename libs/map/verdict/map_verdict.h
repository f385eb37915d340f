// SPDX-License-Identifier: BSD-3-Clause
// Judges a finished map without ground truth. Walls that two passes saw at different places, free space that
// one pass saw through the walls of another, loops that the map contradicts, and stretches of the path that
// no match confirms are collected as hot spots. Each hot spot names a suspect and what to do about it.
//
// Consistency cannot measure the error of a place that the robot saw only once. The verdict states the share
// of the map that several passes saw. Where most of the path is held by nothing, see held_share(), the map is
// not good but unchecked, and the verdict names the stretches to drive again.
#pragma once

#include <mrpt/math/TPoint2D.h>

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "map/verdict/checked_path.h"
#include "map/verdict/edit_effect.h"
#include "map/verdict/open_directions.h"
#include "map/verdict/pass_checks.h"
#include "map/verdict/scene_changes.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/mapping_result.h"

namespace psi_slam {

/// Part of the mapping that probably causes a fault: a loop, or a stretch of the path.
struct Suspect {
  enum class Kind {
    kLoop,       ///< an accepted loop
    kStretch,    ///< a stretch of the path that loops do not hold
    kUnmatched,  ///< scans that matched no local map
    kLost,       ///< the place of the robot was lost, and found again
    kUnplaced,   ///< the place of the robot was lost, and never found
    kGap,        ///< a gap of the log, before the first frame
    kDrift,      ///< a stretch in which the map may have drifted
    kOpen,       ///< scans without odometry that leave the position open along a direction
  };
  Kind kind = Kind::kStretch;
  std::size_t loop = 0;         ///< of a loop: index in MappingResult::loops
  std::size_t local_map = 0;    ///< of a loop: number of the local map
  std::size_t first_frame = 0;  ///< first frame of the stretch, or frame of the loop's anchor
  std::size_t last_frame = 0;   ///< last frame of the stretch, or frame of the loop's node
  mrpt::math::TPoint2D at;      ///< place in the map: the loop's node, or the middle of the stretch
  /// Whether any scan of the map searched for loops. False with loop_closure.enabled=false.
  bool searched_loops = true;
  /// Times of first_frame and last_frame since the start of their run, seconds. Empty: not stated, or the
  /// first frame is in another run.
  std::optional<double> first_s{};
  std::optional<double> last_s{};
};

/// Returns whether two suspects are the same loop or stretch.
inline bool is_same(const Suspect& a, const Suspect& b) {
  return a.kind == b.kind && a.loop == b.loop && a.first_frame == b.first_frame &&
         a.last_frame == b.last_frame;
}

/// A doubtful place of the map.
struct HotSpot {
  enum class Kind {
    kDoubledWall,      ///< two passes saw parallel walls
    kSeenThroughWall,  ///< one pass saw free space where another pass saw a wall
    kRunsDisagree,     ///< different runs saw a wall at different places
    kMisfit,           ///< successive scans of one pass do not fit
    kLoopConflict,     ///< the map contradicts an accepted loop
    kUnmatched,        ///< unmatched scans whose motion no other pass confirms
    kUnplacedRun,      ///< the place of a run in the map was never found
    kGapDisagrees,     ///< scans before and after a gap of the log saw different walls
    kUncertain,        ///< the pose graph predicts a large error
    kOpenDirection,    ///< neither scans nor odometry measure the motion along a direction
  };
  Kind kind = Kind::kDoubledWall;
  mrpt::math::TPoint2D at;  ///< place in the map, metres
  /// Estimated error; an error that is too large to measure counts as 1 m. Empty for an unplaced run.
  std::optional<double> error_m;
  double length_m = 0;  ///< path along which the fault is seen
  Suspect suspect;
  std::size_t places_of_suspect = 1;  ///< number of hot spots with this suspect, this one included
  /// Edit of a loop that helps: deletes the suspect, matches a scan after it with a local map before it, or
  /// forces such a match by hand that was rejected as an outlier. It was tried on the graph: the disagreement
  /// at the place falls to half, and no other place becomes worse. Empty if no such edit was found, or if no
  /// scan of the map searched for loops, because edits then have no effect.
  std::optional<LoopEdit> edit{};
  std::optional<EditEffect> effect{};  ///< what the edit changes
  FrameSpan seen_by{};                 ///< frames whose scans show the fault; empty if the path alone does
  bool edits_tried = false;            ///< whether any edit was tried on the graph for this place
};

/// Returns whether the error of a kind is predicted, not shown by scans.
bool is_predicted(HotSpot::Kind kind);

/// Returns the kind in the words of summary.json: "doubled wall", "wall seen through", ...
std::string text_of(HotSpot::Kind kind);

enum class MapState {
  kGood,       ///< no doubtful place, and passes that fit hold most of the path
  kUnchecked,  ///< no doubtful place, but passes that fit hold at most half of the path
  kCheck,      ///< doubtful places in a map that is right elsewhere
  kBroken,     ///< large parts of the map contradict each other
};

/// Returns "good", "unchecked", "check these places" or "broken".
std::string text_of(MapState state);

struct MapVerdict {
  MapState state = MapState::kUnchecked;
  /// Estimated mean error in metres, from what the scans show: the mean displacement between passes and
  /// between successive scans, and the doubt about stretches and runs that no pass confirms.
  double error_m = 0;
  /// Mean standard deviation of the positions that the graph predicts, metres, without unplaced runs; see
  /// aligned_sigmas_m(). It grows where no loop holds the path, whether or not the scans show an error.
  double predicted_m = 0;
  double wall_thickness_m = 0;  ///< 90th percentile of the distances between the walls of two passes
  double checked_share = 0;     ///< share of the path that another pass confirms or contradicts, in [0, 1]
  double held_share = 0;        ///< share of the path between places where passes fit, see held_share()
  std::vector<HotSpot>
      hot_spots;  ///< at most VerdictOptions::most_hot_spots; those that scans show first, by their error
  std::size_t more_hot_spots = 0;  ///< hot spots beyond those, which are left out of the list
  double largest_error_m = 0;      ///< of all hot spots, metres; 0 without any
  /// Path segments of unmatched scans, in the order of the log, that are not doubtful: the scans before and
  /// after a segment fit, and the segment is the suspect of no hot spot.
  std::vector<FrameSpan> confirmed_stretches;
  /// Path segments that no second pass has checked, the most uncertain first. The robot should pass them
  /// again.
  std::vector<UncheckedStretch> unchecked_stretches;
  /// Path segments, at least VerdictOptions::unconfirmed_m long and in the order of the log, whose scans do
  /// not determine the motion in one direction. Those without odometry are hot spots.
  std::vector<OpenStretch> open_stretches;
  /// Places where the building changed between passes, the place of most comparisons first. Empty for a
  /// broken map, whose poses may be the cause.
  std::vector<SceneChange> changes;

  /// Figure by which maps can be ranked, metres.
  double doubt_m() const { return error_m + predicted_m; }
};

struct VerdictOptions {
  MapViewOptions views;
  PassCheckOptions passes;
  double spot_error_m = 0.2;     ///< minimum displacement between passes that is a hot spot
  double least_length_m = 1.0;   ///< minimum path along which displaced walls are a hot spot
  std::size_t least_checks = 4;  ///< minimum number of displaced comparisons of such a hot spot
  /// Shares of the walls that later scans see through after an interruption or gap, see
  /// InterruptionCheck::contradicted. From `contradiction` on, the place of the robot is doubtful. From
  /// `sure_contradiction` on, it is wrong, because moved furniture alone causes smaller shares.
  double contradiction = 0.05;
  double sure_contradiction = 0.1;
  /// A measured displacement between successive scans from here on is a hot spot.
  double misfit_m = 0.35;
  double uncertain_m = 0.25;  ///< a predicted standard deviation from here on is a hot spot
  double conflict_chi = 6;    ///< a loop residual from here on is a conflict, standard deviations
  double conflict_m = 0.3;    ///< a loop residual from here on is a conflict, metres
  /// Unmatched motion from here on is a hot spot unless a pass confirms it. Motion in open directions without
  /// odometry from here on is a hot spot.
  double unconfirmed_m = 1.0;
  /// Expected error of motion that no scan measures, as a share of the motion.
  double unmatched_error = 0.1;
  double broken_error_m = 0.12;  ///< MapVerdict::error_m from which the map is broken
  std::size_t most_hot_spots = 20;
};

/// Judges a map. Deterministic. A map without scans or without overlapping passes has no displaced walls.
MapVerdict judge_map(const MappingResult& result, const VerdictOptions& options = {});

/// Returns the suspect as a clause: "the loop of scan 812 with local map 14 at (3.1, -2.0) m, 2:42".
std::string text_of(const Suspect& suspect);

/// Returns the verdict as a sentence without full stop: "the map is good: ...".
std::string verdict_sentence(const MapVerdict& verdict);

/// Returns the error of a hot spot: "0.31 m", or "1 m or more" if it was too large to measure. Empty for an
/// unplaced run.
std::string error_text(const HotSpot& spot);

/// Returns the edit of a hot spot as a line of the file of edits: "match scan=812 local_map=14 matcher=csm".
/// Empty without an edit.
std::string edit_line(const HotSpot& spot);

/// Returns a hot spot as a clause: "doubled wall at (3.1, -2.0) m, error about 0.30 m; suspect: ...".
std::string hot_spot_text(const HotSpot& spot);

/// Returns the setting or edit that would help against a hot spot, as a sentence without full stop.
std::string advice_text(const HotSpot& spot);

}  // namespace psi_slam
