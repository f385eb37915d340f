// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/localizer.h"

#include <utility>

#include "base/portable_math.h"
#include "localization/global_search.h"
#include "localization/localizer_options.h"
#include "localization/place_consensus.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// The refined prediction replaces the searched pose if its score is at least this share of the searched
// pose's score. Along a corridor, noise decides where the search finds its best pose.
constexpr double kPredictionShare = 0.95;

}  // namespace

struct Localizer::Members {
  Members(ReferenceMap map, const LocalizerOptions& given)
      : options(given),
        global_search(std::move(map), given.search),
        matcher(given.search.match),
        front_end(given.front_end),
        consensus(given.consensus) {}

  void track(const FrontEndStep& motion, LocalizationStep& step) {
    step.state = LocalizationStep::State::kTracking;
    step.map_T_robot = compose(*map_T_local, motion.local_T_robot);
    step.fits = match_near(motion, step);
    if (fitted_us == 0) fitted_us = now_us;
    if (step.fits) {
      map_T_local = compose(step.map_T_robot, inverse(motion.local_T_robot));
      is_near_given_start = false;
      misfit_m = 0;
      fitted_us = now_us;
      return;
    }
    misfit_m += step.moved_m;
    if (misfit_m <= options.max_misfit_m && seconds(now_us - fitted_us) <= options.max_misfit_s) return;
    step.state = LocalizationStep::State::kLost;
    become_lost();
  }

  bool match_near(const FrontEndStep& motion, LocalizationStep& step) const {
    const LocalMap& map = *global_search.map().fine;
    const ScanPoints& scan = *motion.points;
    if (scan.points.empty() || scan.farthest_m <= map.scores().resolution_m()) return false;
    const SearchExtent window =
        is_near_given_start
            ? SearchExtent{options.start_window_m, options.start_window_m, options.start_window_rad}
            : SearchExtent{options.window_m, options.window_m, options.window_rad};
    MatchProblem problem{map.scores(), scan, step.map_T_robot, window};
    problem.min_response = options.min_response;
    if (!is_near_given_start) {
      const double information_m = 1 / (options.prior_sigma_m * options.prior_sigma_m);
      const double information_rad = 1 / (options.prior_sigma_rad * options.prior_sigma_rad);
      problem.prior.emplace().map_T_robot = step.map_T_robot;
      problem.prior->information.diagonal() << information_m, information_m, information_rad;
    }
    const MatchResult match = matcher.match(problem);
    if (!match.found) return false;
    TPose2D matched = match.map_T_robot;
    if (problem.prior) {
      const RefinedPose predicted =
          refine(map.scores(), scan, step.map_T_robot, options.search.match.refinement, problem.prior);
      if (predicted.mean_score >= kPredictionShare * match.refined_response) matched = predicted.map_T_robot;
    }
    const LocalMap::Agreement agreement = map.agreement(scan, matched);
    const auto points = static_cast<double>(scan.points.size());
    if (static_cast<double>(agreement.observed) < options.min_observed_share * points ||
        agreement.share() < options.min_agree)
      return false;
    step.map_T_robot = matched;
    step.response = match.response;
    step.confidence = static_cast<double>(agreement.hits) / points;
    return true;
  }

  void search(std::size_t frame, LocalizationStep& step) {
    const std::size_t node = keyframes.nodes.size() - 1;
    const NodeScan& here = keyframes.nodes[node];
    const FoundPlace& place =
        step.search.emplace(global_search.find(node, keyframes, {options.seed, frame, 0}));
    if (!place.believed()) return;
    if (!consensus.add(node, keyframes, place)) return;
    map_T_local = compose(place.map_T_robot, inverse(here.local_T_robot));
    misfit_m = 0;
    fitted_us = now_us;
    step.state = LocalizationStep::State::kTracking;
    step.map_T_robot = place.map_T_robot;
    step.fits = true;
    step.response = place.response;
    step.confidence = place.agree * place.observed_share;
  }

  // Starts again without any knowledge of the pose. The robot may have been moved by hand, so the motion
  // measured before is discarded.
  void become_lost() {
    map_T_local.reset();
    is_near_given_start = false;
    front_end.emplace(options.front_end);
    last_local_T_robot = {0, 0, 0};
    keyframes = {};
    consensus = PlaceConsensus(options.consensus);
  }

  LocalizerOptions options;
  GlobalSearch global_search;
  CorrelativeMatcher matcher;
  std::optional<FrontEnd> front_end;
  TPose2D last_local_T_robot;
  std::optional<TPose2D> map_T_local;  ///< pose of the front end's frame in the map; empty while lost
  bool is_near_given_start = false;    ///< true from start_at() until a scan fits
  double misfit_m = 0;                 ///< travel since the last scan that fitted the map
  TimeUs fitted_us = 0;                ///< time of the last scan that fitted the map
  TimeUs now_us = 0;

  // State while lost.
  KeyframeStore keyframes;  ///< nodes since the robot was lost
  PlaceConsensus consensus;
};

Localizer::Localizer(const mrpt::maps::COccupancyGridMap2D& map, const LocalizerOptions& options)
    : Localizer(make_reference_map(map, options.search.resolution_m, options.search.smoothing_sigma_m),
                options) {}

Localizer::Localizer(ReferenceMap map, const LocalizerOptions& options)
    : m_(std::make_unique<Members>(std::move(map), options)) {}

Localizer Localizer::open(const std::filesystem::path& map, const LocalizerOptions& options) {
  return {read_map_file(map), options};
}

Localizer::~Localizer() = default;

void Localizer::start_at(const TPose2D& map_T_robot) {
  m_->map_T_local = compose(map_T_robot, inverse(m_->last_local_T_robot));
  m_->is_near_given_start = true;
  m_->misfit_m = 0;
  m_->fitted_us = m_->now_us;
}

LocalizationStep Localizer::add(const Frame& frame) {
  Members& m = *m_;
  const FrontEndStep motion = m.front_end->add(frame);
  LocalizationStep step;
  step.time_us = m.now_us = frame.time_us;
  const TPose2D moved = between(m.last_local_T_robot, motion.local_T_robot);
  step.moved_m = portable::hypot(moved.x, moved.y);
  m.last_local_T_robot = motion.local_T_robot;
  if (m.map_T_local) {
    m.track(motion, step);
  } else if (motion.node) {
    remember_node(motion, frame.index, m.keyframes);
    if (begins_stretch(m.keyframes.nodes.size() - 1, m.keyframes.nodes, m.options.search_travel_m))
      m.search(frame.index, step);
  }
  return step;
}

}  // namespace psi_slam
