// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_prior.h"

#include <algorithm>
#include <cmath>
#include <system_error>
#include <utility>

#include "base/number_text.h"
#include "base/text_parts.h"
#include "localization/comparison/wall_changes.h"
#include "map/rendering/extended_map.h"
#include "psi_slam/user_error.h"
#include "session/plan_drawing.h"

namespace psi_slam {
namespace {

constexpr double kLeastWall_m = 0.5;    // shorter contradicted walls are not named
constexpr double kToleranceSigmas = 3;  // a wall within this many standard deviations is the same wall
constexpr std::size_t kMostWalls = 5;   // further ones are only counted

PriorMapOptions prior_options(const Settings& settings, const PlacedMapFile& file) {
  PriorMapOptions options;
  options.sigma_m = settings.prior.sigma_m;
  options.offset = file.offset;
  options.source = settings.prior.map;
  options.consensus = settings.mapper.back_end.loop_consensus;
  options.seed = settings.run.seed;
  return options;
}

/// Reads a prior map. `layers` gets the names of the layers of a drawing.
PlacedMapFile read_prior(const Settings& settings, std::vector<std::string>& layers) {
  const PriorOptions& prior = settings.prior;
  if (!is_plan_drawing(prior.map)) return read_placed_map_file(prior.map);
  PlanDrawing drawing = read_plan_drawing(prior.map, {prior.metres_per_unit, prior.layers});
  layers = std::move(drawing.layers);
  return {std::move(drawing.grid)};
}

std::string place_text(const mrpt::math::TPoint2D& place) {
  return "x " + fixed_text(place.x, 1) + " m, y " + fixed_text(place.y, 1) + " m";
}

bool has_cells_of(const mrpt::maps::COccupancyGridMap2D& prior, const mrpt::maps::COccupancyGridMap2D& map) {
  return std::abs(prior.getResolution() - map.getResolution()) < 1e-6F;
}

/// Throws UserError if the cells of a run cannot continue those of the prior map.
void check_extendable(const Settings& settings, const PlacedMapFile& file) {
  const auto resolution_m = static_cast<double>(file.grid.getResolution());
  if (std::abs(resolution_m - settings.map.resolution_m) > 1e-6)
    throw UserError(settings.prior.map + ": its cells have " + shortest_text(file.grid.getResolution()) +
                    " m, but map.resolution_m is " +
                    shortest_text(static_cast<float>(settings.map.resolution_m)) +
                    ", expected equal cells to extend the map. Set map.resolution_m=" +
                    shortest_text(file.grid.getResolution()));
  if (file.offset.x != 0 || file.offset.y != 0)
    throw UserError(settings.prior.map +
                    ": its origin is no multiple of its resolution, so the cells of a run cannot continue "
                    "it. Set origin to [" +
                    trimmed_text(static_cast<double>(file.grid.getXMin()), 4) + ", " +
                    trimmed_text(static_cast<double>(file.grid.getYMin()), 4) +
                    ", 0], or leave out prior.extend");
}

}  // namespace

void check_prior(const Settings& settings, const FixedKnowledge& knowledge) {
  const PriorOptions& prior = settings.prior;
  if (prior.map.empty() && prior.extend)
    throw UserError("prior.extend needs a map to extend. Name it with prior.map=FILE");
  if (!is_plan_drawing(prior.map) && (!prior.layers.empty() || prior.metres_per_unit))
    throw UserError(std::string(prior.layers.empty() ? "prior.metres_per_unit" : "prior.layers") +
                    " is for a drawing, but prior.map " +
                    (prior.map.empty() ? std::string("names no file") : "is " + prior.map) +
                    ". Remove this setting, or name a .dxf file with prior.map");
  if (prior.map.empty()) return;
  if (prior.extend && is_plan_drawing(prior.map))
    throw UserError(
        "prior.extend brings a grid map up to date, but prior.map is a drawing, which does not tell unseen "
        "from free space. Leave out prior.extend");
  const MapFrameOptions& frame = settings.map_frame;
  if (frame.align != MapFrameOptions::kNone || frame.origin_x_m != 0 || frame.origin_y_m != 0)
    throw UserError(
        "prior.map states the frame of the map, but map.align, map.origin_x_m or map.origin_y_m change it. "
        "Remove one of the two");
  if (knowledge.states_frame())
    throw UserError(
        "prior.map states the frame of the map, and so do the lines pose and tag of the edits. Remove "
        "prior.map, or these lines");
}

void check_prior_apart(const Settings& settings, const std::filesystem::path& results_folder) {
  if (settings.prior.map.empty() || is_plan_drawing(settings.prior.map)) return;
  namespace fs = std::filesystem;
  std::error_code ignored;
  const fs::path folder_of_map = fs::absolute(settings.prior.map).parent_path();
  if (!fs::equivalent(folder_of_map, results_folder, ignored)) return;
  throw UserError("prior.map is " + settings.prior.map + ", but the results in " + results_folder.string() +
                  " may replace it. Choose another folder for the results");
}

SessionPrior::SessionPrior(const Settings& settings)
    : options_(settings.prior),
      file_(read_prior(settings, layers_)),
      recorded_{options_.map, sha256_of_map_file(options_.map)},
      map_(file_.grid, prior_options(settings, file_)) {
  if (options_.extend) check_extendable(settings, file_);
}

void SessionPrior::compare_with(const SessionFacts& facts) {
  const auto& before = facts.prior;
  if (!before || before->map != recorded_.map || before->sha256 == recorded_.sha256) return;
  changed_text_ = options_.map +
                  ": this prior map has changed since the session was saved, so the map can differ from that "
                  "of the session. Restore the file to get the same map again";
}

std::optional<std::string> SessionPrior::place(const Mapper& mapper, FixedKnowledge& knowledge,
                                               const std::function<bool(double)>& progress) {
  PriorPlaces places = map_.places(mapper, {}, progress);
  is_interrupted_ = places.is_interrupted;
  fit_ = {places.objection.empty() && !is_interrupted_, places.compared, places.fitting};
  if (is_interrupted_)
    return options_.map +
           ": this map is left out, because the search for the run in it was interrupted. The exported map "
           "has its own frame. Map the log again, or resume its saved session, to align it";
  if (!fit_.is_accepted)
    return options_.map + ": this map is left out, because the run does not fit it: " + places.objection +
           ". The exported map has its own frame. Check that prior.map shows this building in its size" +
           (layers_.empty() ? ""
                            : ", or name the layers with walls by prior.layers (this drawing has: " +
                                  name_list(layers_) + ")");
  std::move(places.poses.begin(), places.poses.end(), std::back_inserter(knowledge.poses));
  return std::nullopt;
}

std::vector<std::string> SessionPrior::compare(const mrpt::maps::COccupancyGridMap2D& map) const {
  if (!fit_.is_accepted) return {};
  std::vector<std::string> sentences;
  const bool is_extended = extends(map);
  if (options_.extend && !is_extended)
    sentences.push_back(
        options_.map +
        ": this map is not extended, because the map of the run exceeds map.max_cells and has "
        "larger cells. Increase map.max_cells");
  WallChangeOptions options;
  options.tolerance_m = tolerance_m();
  options.min_length_m = kLeastWall_m;
  const mrpt::math::TPose2D grid_T_map(-file_.offset.x, -file_.offset.y, 0);
  std::vector<WallChange> gone;
  for (const WallChange& change : find_wall_changes(file_.grid, map, grid_T_map, options).changes)
    if (change.kind != WallChange::Kind::kAppeared) gone.push_back(change);
  if (gone.empty()) return sentences;
  std::stable_sort(gone.begin(), gone.end(),
                   [](const WallChange& a, const WallChange& b) { return a.length_m > b.length_m; });
  std::string text = options_.map + ": the scans see free space at " + std::to_string(gone.size()) +
                     (gone.size() == 1 ? " wall" : " walls") + " of this map: ";
  for (std::size_t i = 0; i < std::min(gone.size(), kMostWalls); ++i)
    text += (i == 0 ? "" : "; ") + fixed_text(gone[i].length_m, 1) + " m from " +
            place_text(gone[i].from + file_.offset) + " to " + place_text(gone[i].to + file_.offset);
  if (gone.size() > kMostWalls) text += "; and shorter ones";
  sentences.push_back(
      text + (is_extended
                  ? ". The exported map shows free space there, too"
                  : ". Correct the map if these walls are gone. Doors that are drawn closed count, too"));
  return sentences;
}

double SessionPrior::tolerance_m() const {
  return std::max(WallChangeOptions().tolerance_m, kToleranceSigmas * options_.sigma_m);
}

bool SessionPrior::extends(const mrpt::maps::COccupancyGridMap2D& map) const {
  return options_.extend && fit_.is_accepted && has_cells_of(file_.grid, map);
}

mrpt::maps::COccupancyGridMap2D::Ptr SessionPrior::extended(
    const mrpt::maps::COccupancyGridMap2D& map) const {
  const bool is_extended = fit_.is_accepted && has_cells_of(file_.grid, map);
  return is_extended ? extended_map(file_.grid, map, tolerance_m())
                     : std::make_shared<mrpt::maps::COccupancyGridMap2D>(map);
}

}  // namespace psi_slam
