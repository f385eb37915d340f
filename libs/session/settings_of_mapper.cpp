// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings.h"

namespace psi_slam {
namespace {

/// Returns the matchers with their names, for an option of type MatcherKind or std::optional<MatcherKind>.
template <class Choice>
std::vector<std::pair<std::string, Choice>> matcher_choices() {
  std::vector<std::pair<std::string, Choice>> choices;
  for (const MatcherKind kind : kMatcherKinds) choices.emplace_back(name(kind), kind);
  return choices;
}

/// Describes the options refine_* and adds them to the current section of the table.
void describe_refinement(OptionTable& table, RefinementOptions& refinement) {
  table
      .number("refine_score_sigma", refinement.score_sigma, between(0.0001, 100), "",
              "Standard deviation of a point's score in the refinement of a match. A larger value trusts the "
              "scan less.")
      .number("refine_converged_step_m", refinement.converged_step_m, above(0).at_most(1), "m",
              "The refinement of a match ends when its step is shorter than this.");
}

void describe_front_end(OptionTable& table, FrontEndOptions& front_end) {
  table.section("front_end", "Matching each scan with the active local map")
      .number("max_range_m", front_end.scan.max_range_m, above(0), "m",
              "Returns farther than this are not matched. The default is no limit for usual 2D lidars.")
      .number("point_spacing_m", front_end.scan.spacing_m, at_least(0).at_most(10), "m",
              "Least distance between neighbouring points of a scan. Nearer points are dropped.")
      .number("window_m", front_end.window_m, above(0).at_most(20), "m",
              "Half-width of the search window along x and y when the robot stands still.")
      .angle_deg("window_theta_deg", front_end.window_rad, above(0).at_most(180),
                 "Half-width of the search window in heading when the robot stands still.")
      .number("window_per_metre", front_end.window_per_metre, at_least(0).at_most(100), "",
              "Metres added to window_m for each metre that the robot moved since the last scan.")
      .number("window_theta_per_turn", front_end.window_per_radian, at_least(0).at_most(100), "",
              "Degrees added to window_theta_deg for each degree that the robot turned since the last scan.")
      .angle_deg("window_theta_per_metre_deg", front_end.window_rad_per_metre, at_least(0).at_most(180),
                 "Angle added to window_theta_deg for each metre that the robot moved since the last scan.")
      .number("max_window_m", front_end.max_window_m, above(0).at_most(20), "m",
              "Largest half-width of the search window along x and y.")
      .angle_deg("max_window_theta_deg", front_end.max_window_rad, above(0).at_most(180),
                 "Largest half-width of the search window in heading.")
      .number(
          "min_response_share", front_end.min_response_share, between(0, 1), "",
          "Least response of a match, as a share of the mean response of the last scans. A scan that matches "
          "worse keeps its predicted pose.")
      .number("poor_response_share", front_end.poor_response_share, between(0, 1), "",
              "A scan whose response is below this share of the mean response of the last scans is searched "
              "again in a wide window, unless this window is hardly wider than the first one.")
      .number("wide_response_gain", front_end.wide_response_gain, at_least(1), "",
              "A match in the wide window of a scan must exceed the response of the poor match by this "
              "factor. If "
              "there is no poor match, it must exceed the least response of a match by this factor.")
      .number("wide_window_per_motion", front_end.wide_window_per_motion, between(0, 100), "",
              "Growth of the wide window of a scan: metres added to window_m for each metre moved, degrees "
              "added to window_theta_deg for each degree turned, and a factor on window_theta_per_metre_deg.")
      .number("max_wide_window_m", front_end.max_wide_window_m, above(0).at_most(20), "m",
              "Largest half-width of the wide window of a scan along x and y.")
      .angle_deg("max_wide_window_theta_deg", front_end.max_wide_window_rad, above(0).at_most(180),
                 "Largest half-width in heading of the wide window of a scan that matches poorly. If it "
                 "matches nothing, all headings are searched.")
      .number("acceleration_mps2", front_end.constant_velocity.acceleration_mps2, above(0).at_most(100),
              "m/s²", "Without odometry: standard deviation of the robot's acceleration.")
      .angle_deg(
          "turn_acceleration_deg", front_end.constant_velocity.turn_acceleration_radps2,
          above(0).at_most(10'000),
          "Without odometry: standard deviation of the robot's angular acceleration, per second squared.")
      .number("unknown_speed_mps", front_end.constant_velocity.unknown_speed_mps, above(0).at_most(100),
              "m/s", "Without odometry: standard deviation of the robot's speed while no match gives it.")
      .angle_deg(
          "unknown_turn_deg", front_end.constant_velocity.unknown_turn_radps, above(0).at_most(10'000),
          "Without odometry: standard deviation of the robot's turn in one second while no match gives "
          "it.")
      .number("known_speed_s", front_end.constant_velocity.longest_s, at_least(0), "s",
              "Without odometry: after this time without a match, the robot's speed counts as unknown.")
      .flag("along_walls", front_end.along_walls,
            "Lets no point of a wall hold the robot along the wall while odometry says that it moves. Keeps "
            "the length of bare corridors.")
      .number("held_share", front_end.held_share, between(0, 1), "",
              "A correction is doubtful if the pose predicted by odometry reaches this share of the matched "
              "pose's response.")
      .number("max_doubtful_correction_sigmas", front_end.doubtful_corrections.max_sigmas, at_least(0), "",
              "Largest doubtful correction, in standard deviations of the motion by odometry since the last "
              "correction. A larger doubtful correction is not applied.")
      .number(
          "max_doubtful_correction_m", front_end.doubtful_corrections.max_sum_m, at_least(0).at_most(100),
          "m",
          "Largest sum of doubtful corrections, such as a person who walks ahead of the robot causes. It is "
          "larger for odometry with larger errors, and for scans far apart.")
      .number("doubtful_correction_travel_m", front_end.doubtful_corrections.travel_m, above(0).at_most(1000),
              "m", "Travel over which the sum of doubtful corrections decays to 37 %.")
      .number("node_distance_m", front_end.node_distance_m, at_least(0).at_most(100), "m",
              "A scan becomes a node of the graph when the robot has moved this far since the last node.")
      .angle_deg(
          "node_rotation_deg", front_end.node_rotation_rad, at_least(0).at_most(180),
          "A scan becomes a node of the graph when the robot has turned this much since the last node.");
  describe_refinement(table, front_end.refinement);
}

void describe_local_maps(OptionTable& table, FrontEndOptions& front_end) {
  LocalMapOptions& local_map = front_end.local_map;
  table.section("local_maps", "Local maps: the occupancy grids that scans are matched with")
      .number("resolution_m", local_map.resolution_m, between(0.005, 1), "m",
              "Side length of a cell of a local map.")
      .number("hit_probability", local_map.hit_probability, above(0.5).below(1), "",
              "Probability that a cell is occupied if a beam ended in it.")
      .number("miss_probability", local_map.miss_probability, above(0).below(0.5), "",
              "Probability that a cell is occupied if a beam passed through it.")
      .number(
          "smoothing_sigma_m", local_map.smoothing_sigma_m, above(0).at_most(5), "m",
          "Standard deviation of the blur that spreads a wall's score. It covers range noise and cell size.")
      .number("max_insert_range_m", local_map.max_insert_range_m, above(0), "m",
              "Longer beams are cut at this range and mark only free space in local maps. The default is no "
              "limit for usual 2D lidars.")
      .integer("nodes", front_end.nodes_per_local_map, between(2, 60000), "nodes",
               "A local map is finished after this many nodes. The next one begins at half of them.")
      .number("travel_m", front_end.local_map_travel_m, above(0), "m",
              "A local map is finished when the robot has travelled this far in it.")
      .number("max_unmatched_travel_m", front_end.max_unmatched_travel_m, above(0), "m",
              "Travel without a match, over at least two scans, after which all local maps are finished. A "
              "covered laser causes this.");
}

void describe_loop_closure(OptionTable& table, MapperOptions& mapper) {
  LoopClosureOptions& loops = mapper.back_end.loop_closure;
  MatcherOptions& matcher = mapper.back_end.loop_matcher;
  LoopCandidateOptions& candidates = loops.candidates;
  auto choices = matcher_choices<std::optional<MatcherKind>>();
  choices.emplace_back("adaptive", std::nullopt);
  table.section("loop_closure", "Loop closing: finding places that the robot has visited before")
      .flag("enabled", mapper.close_loops,
            "Closes loops. Without loops, the map is that of the front end alone.")
      .choice("matcher", mapper.back_end.matcher, choices,
              "How to search for loops: csm is exhaustive, csm_ga partly genetic, ga genetic. adaptive "
              "chooses among them by the factor Psi and the number of poses of the window.")
      .number("window_x_m", candidates.max_window.x_m, above(0).at_most(100), "m",
              "Largest half-width of the search window along x, centred on the predicted pose.")
      .number("window_y_m", candidates.max_window.y_m, above(0).at_most(100), "m",
              "Largest half-width of the search window along y, centred on the predicted pose.")
      .angle_deg("window_theta_deg", candidates.max_window.theta_rad, above(0).at_most(180),
                 "Largest half-width of the search window in heading, centred on the predicted pose.")
      .number("min_window_m", candidates.min_window_m, above(0).at_most(100), "m",
              "Smallest half-width of the search window along x and y.")
      .angle_deg("min_window_theta_deg", candidates.min_window_rad, above(0).at_most(180),
                 "Smallest half-width of the search window in heading.")
      .number("window_sigmas", candidates.window_sigmas, above(0).at_most(100), "",
              "Half-width of the search window in standard deviations of the prediction, within the smallest "
              "and largest half-widths.")
      .number("reach_m", candidates.reach_m, at_least(0).at_most(1000), "m",
              "A local map is searched for loops if one of its nodes is at most this far from the window.")
      .number("min_travel_m", candidates.min_travel_m, at_least(0), "m",
              "Least travel since the last node of a local map before that map is searched for loops. Nearer "
              "nodes share scans with the map.")
      .integer(
          "wide_searches", loops.wide_searches, between(1, 1000), "windows",
          "Largest number of wide windows that a node searches. The next nodes search the remaining windows.")
      .number("attempt_distance_m", loops.attempt_distance_m, at_least(0), "m",
              "Travel from one search for loops to the next.")
      .number("context_travel_m", loops.context.travel_m, at_least(0).at_most(1000), "m",
              "A wide window is searched with all scans of this much travel before the node.")
      .number("context_node_spacing_m", loops.context.node_spacing_m, at_least(0).at_most(1000), "m",
              "Wide windows: least travel between the scans that are searched together.")
      .number("context_point_spacing_m", loops.context.point_spacing_m, above(0).at_most(10), "m",
              "Wide windows: one point is kept in each square of this side length.")
      .integer("context_max_points", loops.context.max_points, between(10, 1'000'000), "points",
               "Wide windows: largest number of points that are searched together. More points are thinned "
               "evenly.")
      .number(
          "distinct_m", matcher.distinct_m, above(0).at_most(100), "m",
          "Another peak of the response is distinct from the best one if it is this far away along x or y.")
      .angle_deg(
          "distinct_deg", matcher.distinct_rad, above(0).at_most(180),
          "Another peak of the response is distinct from the best one if its heading differs by this much.")
      .number("ambiguity_floor", matcher.ambiguity_floor, between(0, 1), "",
              "Other peaks below this share of the best response are ignored.")
      .number("min_sigma_m", matcher.min_sigma_m, above(0).at_most(100), "m",
              "Smallest standard deviation that a match may have.")
      .number("max_sigma_m", matcher.max_sigma_m, above(0).at_most(1000), "m",
              "Largest standard deviation that a match may have.");
  describe_refinement(table, matcher.refinement);
}

void describe_psi(OptionTable& table, PsiOptions& psi) {
  table.section("psi", "Factor Psi: chooses the matcher if loop_closure.matcher = adaptive")
      .number(
          "psi_1", psi.psi_1, any_number(), "",
          "Up to this value of Psi, csm searches windows of at most max_poses poses; for larger values of "
          "Psi, csm_ga or ga. Psi is never negative, so a negative value never uses csm.")
      .number("psi_2", psi.psi_2, any_number(), "",
              "From this value of Psi on, ga searches for loops; between psi_1 and psi_2, csm_ga.")
      .number("max_poses", psi.max_poses, at_least(0), "poses",
              "In windows with more poses than this, ga searches for loops at any Psi.")
      .integer("window_frames", psi.window_frames, between(1, 1'000'000), "searches",
               "Number of previous loop searches whose loops are averaged: K of equation 13.")
      .number("eta_max", psi.eta_max, at_least(1), "",
              "Upper bound of eta, which is path length over distance from the start. It matters near the "
              "start.");
}

void describe_paper_genetic(OptionTable& table, PaperGeneticOptions& paper) {
  table
      .integer("paper_population", paper.population, between(2, 10'000), "poses",
               "Number of poses in a generation of the variant paper.")
      .integer("paper_generations", paper.generations, between(1, 1000), "generations",
               "Number of generations of the variant paper.")
      .number("paper_crossover_rate", paper.crossover_rate, between(0, 1), "",
              "Share of the pairs that the variant paper crosses at two points.")
      .number("paper_mutation_rate", paper.mutation_rate, between(0, 1), "",
              "Probability that a bit flips in the variant paper.");
}

void describe_genetic(OptionTable& table, GeneticOptions& genetic) {
  MemeticGeneticOptions& memetic = genetic.memetic;
  table.section("genetic", "Genetic search of the matchers csm_ga and ga")
      .choice("variant", genetic.variant,
              {{"memetic", GeneticVariant::kMemetic}, {"paper", GeneticVariant::kPaper}},
              "memetic adds a local search to the genetic one. paper is the paper's algorithm, which uses "
              "only the options paper_*.")
      .integer("population", memetic.population, between(2, 10'000), "tiles",
               "Number of tiles in a generation. A tile is a heading and a block of neighbouring shifts.")
      .integer("children", memetic.children, between(1, 10'000), "tiles",
               "Number of new tiles in each generation.")
      .integer("elite", memetic.elite, between(0, 10'000), "tiles",
               "Number of best tiles kept from one generation to the next. 0 keeps none.")
      .integer("generations", memetic.generations, between(0, 10'000), "generations",
               "Largest number of generations.")
      .integer(
          "patience", memetic.patience, between(0, 10'000), "generations",
          "The search ends after this many generations without a better tile. 0 always runs all generations.")
      .number("crossover_rate", memetic.crossover_rate, between(0, 1), "",
              "Share of the new tiles that have two parents.")
      .number("mutation_rate", memetic.mutation_rate, between(0, 1), "",
              "Probability that a bit of a new tile flips.")
      .flag("gray_code", memetic.gray_code,
            "Encodes tiles in Gray code, so that a step in space flips one bit. Otherwise the paper's binary "
            "code is used.")
      .flag("niches", memetic.niches,
            "Keeps only one tile in each neighbourhood, so that two similar corridors both survive.")
      .flag("remember", memetic.remember, "Remembers the scores of tiles, so that no tile is scored twice.")
      .flag("pooled_fitness", memetic.pooled_fitness,
            "Evolves on the coarse, max-pooled score grid before the fine one.")
      .integer("descents", memetic.descents, between(0, 10'000), "tiles",
               "Number of best tiles in each generation that are improved by a descent along the heading.")
      .integer("polished", memetic.polished, between(0, 10'000), "poses",
               "Number of best poses whose neighbourhood is searched exactly at the end.")
      .flag("seed_coarse", memetic.seed_coarse,
            "Takes the first generation from a sparse coarse search. Otherwise it is random.")
      .integer("seeds", memetic.seeds, between(1, 10'000), "tiles",
               "Largest number of tiles that the sparse coarse search (seed_coarse) contributes.")
      .integer("seed_points", memetic.seed_points, between(1, 1'000'000), "points",
               "Number of the scan's points that the sparse coarse search (seed_coarse) uses.")
      .integer("heading_stride", memetic.heading_stride, between(1, 1000), "headings",
               "The sparse coarse search and the coarse stage of csm_ga try only every n-th heading.")
      .integer("coarse_cells", genetic.coarse.cells, between(1, 100'000), "cells",
               "Number of best coarse cells in which csm_ga searches genetically.");
  describe_paper_genetic(table, genetic.paper);
}

void describe_verification(OptionTable& table, LoopVerificationOptions& verification) {
  table.section("verification", "Verification of loops: tests that a match must pass")
      .number("wide_window_m", verification.wide_window_m, at_least(0), "m",
              "Windows with a larger half-width are wide. They contain many places that look alike.")
      .number("min_response", verification.min_response, between(0, 1), "",
              "Narrow windows: least response of a scan.")
      .number("min_context_response", verification.min_context_response, between(0, 1), "",
              "Wide windows: least response of a scan together with the scans before it.")
      .number("max_ambiguity", verification.max_ambiguity, between(0, 1), "",
              "Narrow windows: largest response of another distinct peak, as a share of the best response. "
              "For a match far "
              "from the predicted position, the limit is smaller.")
      .number("max_sigma_m", verification.max_sigma_m, above(0), "m",
              "Largest standard deviation of the matched position.")
      .number("min_observed_share", verification.min_observed_share, between(0, 1), "",
              "Narrow windows: least share of the scan's points in space that the local map has observed.")
      .number("min_neighbours_agree", verification.min_neighbours_agree, between(0, 1), "",
              "Least share of the neighbouring scans' points that fit the local map.")
      .number("min_reverse_agree", verification.min_reverse_agree, between(0, 1), "",
              "Least share of the local map's points that fit the matched scan.")
      .number(
          "neighbourhood_m", verification.neighbourhood_m, at_least(0), "m",
          "Scans up to this much travel before and after the matched scan are its neighbours. Of these, the "
          "nearest and one in every 0.3 m of distance and turn are compared.");
}

void describe_consensus(OptionTable& table, LoopConsensusOptions& consensus) {
  table.section("consensus", "Consensus: loops in wide windows wait until others agree with them")
      .number(
          "memory_m", consensus.memory_m, above(0), "m",
          "Travel after which a waiting match no longer counts. A larger value lets false matches along "
          "equal doors confirm each other, a smaller one loses loops of sparse logs. In searches of a whole "
          "map, matches wait for at least 15 m.")
      .number("min_span_m", consensus.min_span_m, at_least(0), "m",
              "Least travel from the first to the last of the matches that agree.")
      .number("max_other_place_share", consensus.max_rival_share, between(0, 1), "",
              "Largest weight of any other place, as a share of the weight of the matches that agree.");
}

void describe_pose_graph(OptionTable& table, MapperOptions& mapper) {
  PoseAdjustmentOptions& solver = mapper.pose_graph;
  table.section("pose_graph", "Pose graph and its optimisation")
      .number("loop_sigma_m", mapper.back_end.loop_sigma_m, above(0).at_most(1000), "m",
              "Standard deviation of a loop's position, added to the covariance of its match.")
      .angle_deg("loop_sigma_theta_deg", mapper.back_end.loop_sigma_rad, above(0).at_most(180),
                 "Standard deviation of a loop's heading, added to the covariance of its match.")
      .integer("max_iterations", solver.max_iterations, between(1, 10000), "iterations",
               "Largest number of iterations of an optimisation.");
}

void describe_final_search(OptionTable& table, FinalSearchOptions& final_search) {
  table.section("final_search", "Final loop search: matches nodes with nearby local maps after the last scan")
      .integer("passes", final_search.passes, between(0, 100), "passes",
               "Number of final loop searches, each followed by an optimisation. 0 skips the final search.")
      .number("window_m", final_search.window_m, above(0).at_most(100), "m",
              "Half-width of the final search's windows along x and y.")
      .angle_deg("window_theta_deg", final_search.window_rad, above(0).at_most(180),
                 "Half-width of the final search's windows in heading.")
      .number("reach_m", final_search.reach_m, at_least(0).at_most(1000), "m",
              "A node is matched with a local map if one of the map's nodes is at most this far away.")
      .number(
          "travel_m", final_search.travel_m, at_least(0), "m",
          "Where more than 4 local maps are near, each is matched with one node in each stretch of this much "
          "travel. A turn of 1 rad counts as 1.5 m. 0 matches every node.");
}

void describe_joint_refinement(OptionTable& table, JointRefinementOptions& refinement) {
  table
      .section(
          "joint_refinement",
          "Final scan refinement: aligns each scan with the surfaces that nearby scans saw, if loops are "
          "closed")
      .integer("rounds", refinement.rounds, between(0, 100), "rounds",
               "Number of rounds of the final scan refinement. 0 skips it.");
}

}  // namespace

void describe_mapper(OptionTable& table, MapperOptions& mapper) {
  describe_front_end(table, mapper.front_end);
  describe_local_maps(table, mapper.front_end);
  describe_loop_closure(table, mapper);
  describe_psi(table, mapper.back_end.psi);
  describe_genetic(table, mapper.back_end.genetic);
  describe_verification(table, mapper.back_end.loop_closure.verification);
  describe_consensus(table, mapper.back_end.loop_consensus);
  describe_pose_graph(table, mapper);
  describe_final_search(table, mapper.back_end.final_search);
  describe_joint_refinement(table, mapper.back_end.joint_refinement);
}

void describe_localization(OptionTable& table, LocalizerOptions& localization) {
  GlobalSearchOptions& search = localization.search;
  table.section("localization", "psi-slam localize: finding and tracking a robot in a finished map")
      .choice(
          "matcher", search.matcher, matcher_choices<MatcherKind>(),
          "Matcher that searches the whole map while the robot is lost. The exact search, csm, also checks "
          "each place that csm_ga or ga finds and that would be accepted.")
      .number("search_resolution_m", search.resolution_m, between(0.005, 10), "m",
              "Cell size for searching the whole map. Larger cells of the map itself are kept.")
      .number("search_travel_m", localization.search_travel_m, above(0).at_most(10), "m",
              "While lost: travel from one search of the whole map to the next.")
      .number("context_travel_m", search.context.travel_m, at_least(0), "m",
              "The whole map is searched with all scans of this much travel.")
      .number("context_node_spacing_m", search.context.node_spacing_m, at_least(0), "m",
              "Search of the whole map: least travel between the scans that are searched together.")
      .number("context_point_spacing_m", search.context.point_spacing_m, above(0), "m",
              "Search of the whole map: one point is kept in each square of this side length.")
      .integer("context_max_points", search.context.max_points, between(10, 1'000'000), "points",
               "Search of the whole map: largest number of points that are searched together.")
      .number("min_search_response", search.min_response, between(0, 1), "",
              "Search of the whole map: least response of a place.")
      .number("max_ambiguity", search.max_ambiguity, between(0, 1), "",
              "Search of the whole map: largest response of another place, as a share of the best. A higher "
              "value needs more searches to agree.")
      .number("min_search_observed_share", search.min_observed_share, between(0, 1), "",
              "Search of the whole map: least share of the points that lie in observed space.")
      .number("min_search_agree", search.min_agree, between(0, 1), "",
              "Search of the whole map: least share of the points in observed space that lie on walls.")
      .number(
          "min_clear_share", search.min_clear_share, between(0, 1), "",
          "Search of the whole map: least share of the beams that pass through no wall, where another place "
          "fits nearly as well.")
      .number(
          "min_clear_share_alone", search.min_clear_share_alone, between(0, 1), "",
          "Search of the whole map: least share of the beams that pass through no wall, where no other place "
          "has three quarters of the response. Furniture and specks of the map block beams too.")
      .number("min_response", localization.min_response, between(0, 1), "",
              "Tracking: least response of a scan.")
      .number("min_agree", localization.min_agree, between(0, 1), "",
              "Tracking: least share of a scan's points in observed space that lie on walls.")
      .number("min_observed_share", localization.min_observed_share, between(0, 1), "",
              "Tracking: least share of a scan's points that lie in observed space.")
      .number("window_m", localization.window_m, above(0).at_most(100), "m",
              "Tracking: half-width of the search window along x and y.")
      .angle_deg("window_theta_deg", localization.window_rad, above(0).at_most(180),
                 "Tracking: half-width of the search window in heading.")
      .number("prior_sigma_m", localization.prior_sigma_m, above(0).at_most(100), "m",
              "Tracking: standard deviation of the predicted position. The prediction fixes the pose where "
              "the scan does not.")
      .angle_deg("prior_sigma_theta_deg", localization.prior_sigma_rad, above(0).at_most(180),
                 "Tracking: standard deviation of the predicted heading. The prediction fixes the heading "
                 "where the scan does not.")
      .number("start_window_m", localization.start_window_m, above(0).at_most(100), "m",
              "Half-width along x and y of the search windows from --start until a scan fits the map.")
      .angle_deg("start_window_theta_deg", localization.start_window_rad, above(0).at_most(180),
                 "Half-width in heading of the search windows from --start until a scan fits the map.")
      .number("max_misfit_m", localization.max_misfit_m, at_least(0), "m",
              "The robot counts as lost after more than this much travel without a fitting scan.")
      .number("max_misfit_s", localization.max_misfit_s, at_least(0), "s",
              "The robot counts as lost after more than this time without a fitting scan.");
}

}  // namespace psi_slam
