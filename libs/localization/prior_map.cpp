// SPDX-License-Identifier: BSD-3-Clause
#include "localization/prior_map.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "base/portable_math.h"
#include "localization/place_consensus.h"
#include "logs/frames/pose_operations.h"
#include "logs/frames/position_variance.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// Path length between places. Longer paths have a larger one, so that they have at most kMostPlaces.
constexpr double kSpacing_m = 4;
constexpr double kMostPlaces = 300;
// Least path length between searches of the whole map, and their largest number.
constexpr double kSearchSpacing_m = 2;
constexpr int kMostSearches = 100;
constexpr double kShareOfSearches = 0.5;  // of the work, if all searches fail

// A place matches the scans of this path. Few points keep the information of the match low: neighbouring
// points share the errors of the walls.
constexpr ScanContextOptions kContext{6.0, 0.5, 0.2, 800};

// The window around a prediction grows with the path since the last place that was known firmly.
constexpr double kWindow_m = 0.3;
constexpr double kWindowGrowth = 0.06;
constexpr double kMostWindow_m = 4;
constexpr double kWindow_rad = radians_from_degrees(6.0L);
constexpr double kFirm_m = 0.1;         // largest standard deviation of a firm place
constexpr double kWideWindow_m = 0.5;   // wider windows may contain several places
constexpr double kMaxAmbiguity = 0.95;  // of a place in a wide window
// The refined prediction replaces the matched pose if its score is at least this share of the match's.
// Along a corridor, noise decides where the search finds its best pose.
constexpr double kPriorPredictionShare = 0.95;

// Least shares of a place: of the response, of the points in space that the map shows, of these on walls, and
// of the beams that cross no wall.
constexpr double kMinResponse = 0.3;
constexpr double kMinObserved = 0.5;
constexpr double kMinAgree = 0.4;
constexpr double kMinClear = 0.8;

// Two hypotheses about the run: it was made in the building of the map, where nine of ten places fit, nine of
// ten of them where the path from the place before leads. Or it was made in another building, where a place
// fits by chance, anywhere in its window. The run is in the building if the logarithm of the likelihood ratio
// is at least kLeastEvidence.
constexpr double kFitsInBuilding = 0.9;
constexpr double kFitsByChance = 0.3;
constexpr double kFollowsPath = 0.9;
constexpr double kLeastEvidence = 10;
constexpr double kDrift = 0.01;  // of the path between two places, per metre; and of its heading, per metre

constexpr double kSearchResolution_m = 0.1;
constexpr double kHeadingArm_m = 5;  // a heading is as uncertain as the wall at this distance

// A bare plan lacks furniture, so the beams, which furniture cannot make cross a wall, must prove the place.
GlobalSearchOptions search_options() {
  GlobalSearchOptions options;
  options.min_response = 0.4;
  options.min_agree = 0.5;
  options.min_clear_share_alone = 0.8;
  return options;
}

// Numbers of the nodes that get a place, in their order. Superseded nodes have no points to match.
std::vector<std::size_t> spaced_nodes(const KeyframeStore& keyframes) {
  const std::vector<NodeScan>& nodes = keyframes.nodes;
  double length_m = 0;
  for (std::size_t node = 1; node < nodes.size(); ++node)
    if (nodes[node].points) length_m += nodes[node].travelled_m - nodes[node - 1].travelled_m;
  const double spacing_m = std::max(kSpacing_m, length_m / kMostPlaces);
  std::vector<std::size_t> spaced;
  for (std::size_t node = 0; node < nodes.size(); ++node) {
    const bool is_due = spaced.empty() || node + 1 == nodes.size() ||
                        nodes[node].travelled_m - nodes[spaced.back()].travelled_m >= spacing_m;
    if (is_due && nodes[node].points && !is_unplaced(node, keyframes)) spaced.push_back(node);
  }
  return spaced;
}

/// Returns by how much the place of a fitting scan favours that the run is in the building of the map.
/// `way_m` is the path since the place that the prediction starts from.
double evidence_of_fit(const MeasuredPose& place, const TPose2D& predicted, const SearchExtent& window,
                       double way_m) {
  const double sigma_m2 = 2 * place.sigma_m * place.sigma_m + kDrift * kDrift * way_m * way_m;
  const double sigma_rad2 = 2 * *place.sigma_rad * *place.sigma_rad + kDrift * kDrift * way_m * way_m;
  Eigen::Matrix3d covariance = place.further;
  covariance.diagonal() += Eigen::Vector3d(sigma_m2, sigma_m2, sigma_rad2);
  const Eigen::Vector3d off(place.pose.x - predicted.x, place.pose.y - predicted.y,
                            mrpt::math::wrapToPi(place.pose.phi - predicted.phi));
  const double chi2 = off.dot(covariance.inverse() * off);
  // A place is found within its window only, so its density there is never below that of chance.
  const double window_volume = 8 * window.x_m * window.y_m * window.theta_rad;
  const double spread = std::sqrt(8 * M_PI * M_PI * M_PI * covariance.determinant());
  const double ratio = portable::exp(-chi2 / 2) * window_volume / std::min(spread, window_volume);
  return portable::log(kFitsInBuilding / kFitsByChance * (kFollowsPath * ratio + (1 - kFollowsPath)));
}

}  // namespace

/// Reports the progress of a search. Nothing more is searched once it is stopped.
class PriorMap::Progress {
 public:
  explicit Progress(const std::function<bool(double)>& report) : report_(report) {}

  /// Reports a completed share of the current part of the work, in [0, 1]. Returns whether the work
  /// continues.
  bool at(double share) {
    share_ = begin_ + share * (1 - begin_);
    stopped_ = stopped_ || (report_ && !report_(share_));
    return !stopped_;
  }
  /// The rest of the work becomes the current part.
  void begin_rest() { begin_ = share_; }
  bool stopped() const { return stopped_; }

 private:
  const std::function<bool(double)>& report_;
  double begin_ = 0;
  double share_ = 0;
  bool stopped_ = false;
};

/// Nodes of a run that get a place, and the places found.
struct PriorMap::Path {
  const KeyframeStore& keyframes;
  const std::vector<TPose2D>& map_T_node;
  std::vector<std::size_t> nodes;
  std::vector<std::optional<MeasuredPose>> places;  ///< of each of `nodes`
  std::size_t first = 0;                            ///< index in `nodes` of the node near the place found
  TPose2D prior_T_map;                              ///< at that node
  std::size_t fits = 0;
  std::size_t misfits = 0;
  double evidence = 0;  ///< log-likelihood ratio of both hypotheses

  void begin_at(const PriorStart& start) {
    prior_T_map = compose(start.prior_T_node, inverse(map_T_node[start.node]));
    const auto after = std::upper_bound(nodes.begin(), nodes.end(), start.node);
    first = static_cast<std::size_t>(std::max<std::ptrdiff_t>(after - nodes.begin(), 1)) - 1;
  }
};

PriorMap::PriorMap(const mrpt::maps::COccupancyGridMap2D& map, PriorMapOptions options)
    : options_(std::move(options)),
      search_(make_reference_map(map, kSearchResolution_m, kFineSmoothing_m), search_options()),
      matcher_(MatcherOptions()) {}

FoundPlace PriorMap::place_anywhere(std::size_t node, const KeyframeStore& keyframes) const {
  return search_.find(node, keyframes, {options_.seed, keyframes.nodes[node].frame, 0});
}

MeasuredPose PriorMap::with_errors_of_walls(const TPose2D& prior_T_robot) const {
  return {prior_T_robot, options_.sigma_m, options_.sigma_m / kHeadingArm_m};
}

std::optional<MeasuredPose> PriorMap::place_near(std::size_t node, const KeyframeStore& keyframes,
                                                 const TPose2D& prior_T_predicted,
                                                 const SearchExtent& window) const {
  const LocalMap& map = *search_.map().fine;
  const ScanPoints context = scan_context(node, keyframes, kContext);
  if (context.points.empty() || context.farthest_m <= map.scores().resolution_m()) return std::nullopt;
  MatchProblem problem{map.scores(), context, prior_T_predicted, window};
  problem.min_response = kMinResponse;
  problem.measure_ambiguity = std::max(window.x_m, window.y_m) > kWideWindow_m;
  problem.prior.emplace().map_T_robot = prior_T_predicted;
  const auto weak = [](double half_width) { return 1 / (half_width * half_width); };
  problem.prior->information.diagonal() << weak(window.x_m), weak(window.y_m), weak(window.theta_rad);
  const MatchResult match = matcher_.match(problem);
  if (!match.found || match.ambiguity.value_or(0) > kMaxAmbiguity) return std::nullopt;
  TPose2D matched = match.map_T_robot;
  Eigen::Matrix3d covariance = match.covariance;
  const RefinedPose predicted =
      refine(map.scores(), context, prior_T_predicted, RefinementOptions(), problem.prior);
  if (predicted.mean_score >= kPriorPredictionShare * match.refined_response) {
    matched = predicted.map_T_robot;
    // Both poses fit, so the place is at least as uncertain as they are apart.
    const Eigen::Vector3d apart(matched.x - match.map_T_robot.x, matched.y - match.map_T_robot.y,
                                mrpt::math::wrapToPi(matched.phi - match.map_T_robot.phi));
    covariance += apart * apart.transpose();
  }
  const LocalMap::Agreement agreement = map.agreement(context, matched);
  const auto points = static_cast<double>(context.points.size());
  if (static_cast<double>(agreement.observed) < kMinObserved * points || agreement.share() < kMinAgree ||
      clear_beams(map.scores(), *keyframes.nodes[node].points, matched).share() < kMinClear)
    return std::nullopt;
  MeasuredPose place = with_errors_of_walls(matched);
  place.further = covariance;
  return place;
}

// Whether the map shows most of the space in which the points of the node would lie.
bool PriorMap::shows(std::size_t node, const KeyframeStore& keyframes, const TPose2D& prior_T_robot) const {
  const ScanPoints& scan = *keyframes.nodes[node].points;
  const LocalMap::Agreement agreement = search_.map().fine->agreement(scan, prior_T_robot);
  return static_cast<double>(agreement.observed) >=
         kMinObserved * static_cast<double>(std::max<std::size_t>(scan.points.size(), 1));
}

// Finds the first place. Returns why there is none, a clause; empty if there is one, or if the search was
// stopped.
std::string PriorMap::find(Path& path, Progress& progress) const {
  const std::vector<NodeScan>& nodes = path.keyframes.nodes;
  const double most_searches =
      std::min<double>(kMostSearches, nodes.back().travelled_m / kSearchSpacing_m + 1);
  PlaceConsensus consensus(options_.consensus);
  std::string why_not = "the run has no scan with points";
  std::optional<double> searched_m;
  int searches = 0;
  for (std::size_t node = 0; node < nodes.size() && searches < kMostSearches; ++node) {
    const bool is_due =
        !searched_m || nodes[node].travelled_m - *searched_m >= kSearchSpacing_m || node + 1 == nodes.size();
    if (!is_due || !nodes[node].points || is_unplaced(node, path.keyframes)) continue;
    if (!progress.at(kShareOfSearches * std::min(1.0, searches / most_searches))) return {};
    searched_m = nodes[node].travelled_m;
    ++searches;
    const FoundPlace place = place_anywhere(node, path.keyframes);
    if (!place.believed()) {
      why_not = place.objection;
      continue;
    }
    why_not = "too few scans agree about the place";
    if (!consensus.add(node, path.keyframes, place)) continue;
    path.begin_at({node, place.map_T_robot});
    return {};
  }
  return why_not;
}

// Matches the scans along the path near their predicted places, forwards and backwards from the first place.
void PriorMap::follow(Path& path, Progress& progress) const {
  std::size_t done = 0;
  const double misfit = portable::log((1 - kFitsInBuilding) / (1 - kFitsByChance));
  const auto step = [&](std::size_t i, TPose2D& prior_T_map, double& last_m, double& firm_m) {
    if (!progress.at(static_cast<double>(done++) / static_cast<double>(path.nodes.size()))) return;
    const std::size_t node = path.nodes[i];
    const double travelled_m = path.keyframes.nodes[node].travelled_m;
    const double half_m = std::min(kWindow_m + kWindowGrowth * std::abs(travelled_m - firm_m), kMostWindow_m);
    const TPose2D predicted = compose(prior_T_map, path.map_T_node[node]);
    const SearchExtent window{half_m, half_m, kWindow_rad};
    const std::optional<MeasuredPose> place = place_near(node, path.keyframes, predicted, window);
    if (!place) {
      if (!shows(node, path.keyframes, predicted)) return;
      ++path.misfits;
      path.evidence += misfit;
      return;
    }
    ++path.fits;
    // The first place was found by the same match.
    if (i != path.first)
      path.evidence += evidence_of_fit(*place, predicted, window, std::abs(travelled_m - last_m));
    last_m = travelled_m;
    path.places[i] = *place;
    prior_T_map = compose(place->pose, inverse(path.map_T_node[node]));
    if (std::sqrt(largest_position_variance_m2(place->further)) <= kFirm_m) firm_m = travelled_m;
  };
  const double start_m = path.keyframes.nodes[path.nodes[path.first]].travelled_m;
  TPose2D prior_T_map = path.prior_T_map;
  double last_m = start_m;
  double firm_m = start_m;
  for (std::size_t i = path.first; i < path.nodes.size(); ++i) step(i, prior_T_map, last_m, firm_m);
  prior_T_map = path.prior_T_map;
  last_m = firm_m = start_m;
  for (std::size_t i = path.first; i-- > 0;) step(i, prior_T_map, last_m, firm_m);
}

PriorPlaces PriorMap::places(const Mapper& mapper, const std::optional<PriorStart>& start,
                             const std::function<bool(double)>& progress) const {
  PriorPlaces result;
  Progress steps(progress);
  const KeyframeStore& keyframes = mapper.keyframes();
  if (keyframes.nodes.empty()) {
    result.objection = "the run has no scan with points";
    return result;
  }
  const std::vector<TPose2D> map_T_node = mapper.graph().poses();
  Path path{keyframes, map_T_node, spaced_nodes(keyframes), {}, 0, {}, 0, 0};
  path.places.resize(path.nodes.size());
  if (start)
    path.begin_at(*start);
  else
    result.objection = find(path, steps);
  if (!result.objection.empty()) return result;
  steps.begin_rest();
  if (!steps.stopped()) follow(path, steps);
  result.is_interrupted = steps.stopped();
  if (result.is_interrupted) return result;
  result.compared = path.fits + path.misfits;
  result.fitting = path.fits;
  if (!(path.evidence >= kLeastEvidence)) {
    result.objection = path.misfits > 0 ? "only " + std::to_string(result.fitting) + " of " +
                                              std::to_string(result.compared) + " places along the path fit"
                                        : "the path is too short, with " + std::to_string(result.fitting) +
                                              " places to compare";
    return result;
  }
  const std::vector<FrameRecord>& frames = mapper.frames();
  const std::vector<std::size_t>& runs = mapper.later_run_frames();
  for (std::size_t i = 0; i < path.nodes.size(); ++i) {
    if (!path.places[i]) continue;
    KnownPose pose;
    const std::size_t frame = keyframes.nodes[path.nodes[i]].frame;
    const auto next_run = std::upper_bound(runs.begin(), runs.end(), frame);
    pose.time_us = frames[frame].time_us;
    pose.from_scan = next_run == runs.begin() ? 0 : *(next_run - 1);
    pose.site_T_robot = *path.places[i];
    pose.site_T_robot.pose.x += options_.offset.x;
    pose.site_T_robot.pose.y += options_.offset.y;
    pose.source = options_.source;
    pose.is_matched = true;
    pose.scan = frame;
    result.poses.push_back(std::move(pose));
  }
  if (result.poses.empty()) result.objection = "no place along the path fits";
  return result;
}

}  // namespace psi_slam
