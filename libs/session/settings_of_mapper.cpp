// SPDX-License-Identifier: BSD-3-Clause
// Options of the mapper and the localizer: results and limits of resources that users choose. The numbers of
// the method are constants. The structs that declare them state what they are, their units, and why they have
// these values. Their names below let programs of research change them.
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

void describe_front_end(OptionTable& table, FrontEndOptions& front_end) {
  table.section("front_end", "Matching each scan with the active local map")
      .number("node_distance_m", front_end.node_distance_m, at_least(0).at_most(100), "m",
              "A scan becomes a node of the graph when the robot has moved this far since the last node. "
              "Raise it "
              "to save memory and time in very long runs.")
      .angle_deg(
          "node_rotation_deg", front_end.node_rotation_rad, at_least(0).at_most(180),
          "A scan becomes a node of the graph when the robot has turned this much since the last node. Raise "
          "it to save memory and time in very long runs.");
  ConstantVelocityOptions& model = front_end.constant_velocity;
  table.constant("front_end.max_range_m", front_end.scan.max_range_m, above(0))
      .constant("front_end.point_spacing_m", front_end.scan.spacing_m)
      .constant("front_end.window_m", front_end.window_m, above(0).at_most(20))
      .constant("front_end.window_theta_deg", front_end.window_rad, above(0).at_most(180))
      .constant("front_end.window_per_metre", front_end.window_per_metre)
      .constant("front_end.window_theta_per_turn", front_end.window_per_radian)
      .constant("front_end.window_theta_per_metre_deg", front_end.window_rad_per_metre)
      .constant("front_end.max_window_m", front_end.max_window_m, above(0).at_most(20))
      .constant("front_end.max_window_theta_deg", front_end.max_window_rad, above(0).at_most(180))
      .constant("front_end.min_response_share", front_end.min_response_share, between(0, 1))
      .constant("front_end.poor_response_share", front_end.poor_response_share, between(0, 1))
      .constant("front_end.wide_response_gain", front_end.wide_response_gain, at_least(1))
      .constant("front_end.wide_window_per_motion", front_end.wide_window_per_motion)
      .constant("front_end.max_wide_window_m", front_end.max_wide_window_m, above(0).at_most(20))
      .constant("front_end.max_wide_window_theta_deg", front_end.max_wide_window_rad, above(0).at_most(180))
      .constant("front_end.acceleration_mps2", model.acceleration_mps2, above(0))
      .constant("front_end.turn_acceleration_deg", model.turn_acceleration_radps2, above(0))
      .constant("front_end.unknown_speed_mps", model.unknown_speed_mps, above(0))
      .constant("front_end.unknown_turn_deg", model.unknown_turn_radps, above(0))
      .constant("front_end.known_speed_s", model.longest_s)
      .constant("front_end.along_walls", front_end.along_walls)
      .constant("front_end.held_share", front_end.held_share, between(0, 1))
      .constant("front_end.max_doubtful_correction_sigmas", front_end.doubtful_corrections.max_sigmas)
      .constant("front_end.max_doubtful_correction_m", front_end.doubtful_corrections.max_sum_m)
      .constant("front_end.doubtful_correction_travel_m", front_end.doubtful_corrections.travel_m, above(0))
      .constant("front_end.refine_score_sigma", front_end.refinement.score_sigma, between(0.0001, 100))
      .constant("front_end.refine_converged_step_m", front_end.refinement.converged_step_m,
                above(0).at_most(1));
}

void describe_local_maps(OptionTable& table, FrontEndOptions& front_end) {
  LocalMapOptions& local_map = front_end.local_map;
  table.section("local_maps", "Local maps: the occupancy grids that scans are matched with")
      .number("resolution_m", local_map.resolution_m, between(0.005, 1), "m",
              "Side length of a cell of a local map. Raise it for sites much larger than buildings.")
      .number(
          "smoothing_sigma_m", local_map.smoothing_sigma_m, above(0).at_most(5), "m",
          "Standard deviation of the blur that spreads a wall's score. It covers range noise and cell size. "
          "Raise it if the ranges of the laser have a larger noise.")
      .constant("local_maps.hit_probability", local_map.hit_probability, above(0.5).below(1))
      .constant("local_maps.miss_probability", local_map.miss_probability, above(0).below(0.5))
      .constant("local_maps.max_insert_range_m", local_map.max_insert_range_m, above(0))
      .constant("local_maps.nodes", front_end.nodes_per_local_map, between(2, 60000))
      .constant("local_maps.travel_m", front_end.local_map_travel_m, above(0))
      .constant("local_maps.max_unmatched_travel_m", front_end.max_unmatched_travel_m, above(0));
}

void describe_loop_closure(OptionTable& table, MapperOptions& mapper) {
  auto choices = matcher_choices<std::optional<MatcherKind>>();
  choices.emplace_back("adaptive", std::nullopt);
  table.section("loop_closure", "Loop closing: finding places that the robot has visited before")
      .flag("enabled", mapper.close_loops,
            "Closes loops. Without loops, the map is that of the front end alone.")
      .choice("matcher", mapper.back_end.matcher, choices,
              "How to search for loops: csm is exhaustive, csm_ga partly genetic, ga genetic. adaptive "
              "chooses among them by the factor Psi and the number of poses of the window.");
  LoopClosureOptions& loops = mapper.back_end.loop_closure;
  LoopCandidateOptions& candidates = loops.candidates;
  MatcherOptions& matcher = mapper.back_end.loop_matcher;
  table.constant("loop_closure.window_x_m", candidates.max_window.x_m, above(0).at_most(100))
      .constant("loop_closure.window_y_m", candidates.max_window.y_m, above(0).at_most(100))
      .constant("loop_closure.window_theta_deg", candidates.max_window.theta_rad, above(0).at_most(180))
      .constant("loop_closure.min_window_m", candidates.min_window_m, above(0).at_most(100))
      .constant("loop_closure.min_window_theta_deg", candidates.min_window_rad, above(0).at_most(180))
      .constant("loop_closure.window_sigmas", candidates.window_sigmas, above(0))
      .constant("loop_closure.reach_m", candidates.reach_m)
      .constant("loop_closure.min_travel_m", candidates.min_travel_m)
      .constant("loop_closure.wide_searches", loops.wide_searches, at_least(1))
      .constant("loop_closure.attempt_distance_m", loops.attempt_distance_m)
      .constant("loop_closure.context_travel_m", loops.context.travel_m)
      .constant("loop_closure.context_node_spacing_m", loops.context.node_spacing_m)
      .constant("loop_closure.context_point_spacing_m", loops.context.point_spacing_m, above(0))
      .constant("loop_closure.context_max_points", loops.context.max_points, between(10, 1e6))
      .constant("loop_closure.distinct_m", matcher.distinct_m, above(0))
      .constant("loop_closure.distinct_deg", matcher.distinct_rad, above(0).at_most(180))
      .constant("loop_closure.ambiguity_floor", matcher.ambiguity_floor, between(0, 1))
      .constant("loop_closure.min_sigma_m", matcher.min_sigma_m, above(0).at_most(100))
      .constant("loop_closure.max_sigma_m", matcher.max_sigma_m, above(0).at_most(1000))
      .constant("loop_closure.refine_score_sigma", matcher.refinement.score_sigma, between(0.0001, 100))
      .constant("loop_closure.refine_converged_step_m", matcher.refinement.converged_step_m,
                above(0).at_most(1));
}

void describe_psi(OptionTable& table, PsiOptions& psi) {
  table.section("psi", "Factor Psi: chooses the matcher if loop_closure.matcher = adaptive")
      .number(
          "psi_1", psi.psi_1, any_number(), "",
          "Up to this value of Psi, csm searches windows of at most max_poses poses; for larger values of "
          "Psi, csm_ga or ga. Set a negative value to disable csm.")
      .number("psi_2", psi.psi_2, any_number(), "",
              "From this value of Psi on, ga searches for loops; between psi_1 and psi_2, csm_ga.")
      .number("max_poses", psi.max_poses, at_least(0), "poses",
              "In windows with more poses than this, ga searches for loops at any Psi.")
      .constant("psi.window_frames", psi.window_frames, at_least(1))
      .constant("psi.eta_max", psi.eta_max, at_least(1));
}

void describe_genetic(OptionTable& table, GeneticOptions& genetic) {
  table.section("genetic", "Genetic search for loops, of the matchers ga and csm_ga")
      .choice("variant", genetic.variant,
              {{"memetic", GeneticVariant::kMemetic}, {"paper", GeneticVariant::kPaper}},
              "memetic adds a local search to the genetic one. paper is the algorithm as published.");
  PaperGeneticOptions& paper = genetic.paper;
  MemeticGeneticOptions& memetic = genetic.memetic;
  table.constant("genetic.paper_population", paper.population, between(2, 1e4))
      .constant("genetic.paper_generations", paper.generations, between(1, 1000))
      .constant("genetic.paper_crossover_rate", paper.crossover_rate, between(0, 1))
      .constant("genetic.paper_mutation_rate", paper.mutation_rate, between(0, 1))
      .constant("genetic.population", memetic.population, between(2, 1e4))
      .constant("genetic.children", memetic.children, between(1, 1e4))
      .constant("genetic.elite", memetic.elite)
      .constant("genetic.generations", memetic.generations)
      .constant("genetic.patience", memetic.patience)
      .constant("genetic.mutation_rate", memetic.mutation_rate, between(0, 1))
      .constant("genetic.seeds", memetic.seeds, between(1, 1e4))
      .constant("genetic.seed_points", memetic.seed_points, between(1, 1e6));
}

void name_evidence_of_loops(OptionTable& table, BackEndOptions& back_end) {
  LoopVerificationOptions& verification = back_end.loop_closure.verification;
  LoopConsensusOptions& consensus = back_end.loop_consensus;
  table.constant("verification.wide_window_m", verification.wide_window_m)
      .constant("verification.min_response", verification.min_response, between(0, 1))
      .constant("verification.min_context_response", verification.min_context_response, between(0, 1))
      .constant("verification.max_ambiguity", verification.max_ambiguity, between(0, 1))
      .constant("verification.max_sigma_m", verification.max_sigma_m, above(0))
      .constant("verification.min_observed_share", verification.min_observed_share, between(0, 1))
      .constant("verification.min_neighbours_agree", verification.min_neighbours_agree, between(0, 1))
      .constant("verification.min_reverse_agree", verification.min_reverse_agree, between(0, 1))
      .constant("verification.neighbourhood_m", verification.neighbourhood_m)
      .constant("consensus.memory_m", consensus.memory_m, above(0))
      .constant("consensus.min_span_m", consensus.min_span_m)
      .constant("consensus.max_other_place_share", consensus.max_rival_share, between(0, 1));
}

void describe_back_end(OptionTable& table, MapperOptions& mapper) {
  BackEndOptions& back_end = mapper.back_end;
  FinalSearchOptions& final_search = back_end.final_search;
  table.section("pose_graph", "Pose graph and its optimisation")
      .integer("max_iterations", mapper.pose_graph.max_iterations, between(1, 10000), "iterations",
               "Maximum number of iterations of an optimisation. Lower it to bound the time of each one.")
      .section("final_search", "Final loop search: matches nodes with nearby local maps after the last scan")
      .integer(
          "passes", final_search.passes, between(0, 100), "passes",
          "Number of final loop searches, each followed by an optimisation. 0 skips the final search and "
          "saves its time.")
      .section(
          "joint_refinement",
          "Final scan refinement: aligns each scan with the surfaces that nearby scans saw, if loops are "
          "closed")
      .integer("rounds", back_end.joint_refinement.rounds, between(0, 100), "rounds",
               "Number of rounds of the final scan refinement. 0 skips it and saves its time.")
      .constant("pose_graph.loop_sigma_m", back_end.loop_sigma_m, above(0).at_most(1000))
      .constant("pose_graph.loop_sigma_theta_deg", back_end.loop_sigma_rad, above(0).at_most(180))
      .constant("final_search.window_m", final_search.window_m, above(0).at_most(100))
      .constant("final_search.window_theta_deg", final_search.window_rad, above(0).at_most(180))
      .constant("final_search.reach_m", final_search.reach_m)
      .constant("final_search.travel_m", final_search.travel_m);
}

}  // namespace

void describe_mapper(OptionTable& table, MapperOptions& mapper) {
  describe_front_end(table, mapper.front_end);
  describe_local_maps(table, mapper.front_end);
  describe_loop_closure(table, mapper);
  describe_psi(table, mapper.back_end.psi);
  describe_genetic(table, mapper.back_end.genetic);
  name_evidence_of_loops(table, mapper.back_end);
  describe_back_end(table, mapper);
}

void describe_localization(OptionTable& table, LocalizerOptions& localization) {
  GlobalSearchOptions& search = localization.search;
  table.section("localization", "psi-slam localize: finding and tracking a robot in a finished map")
      .choice(
          "matcher", search.matcher, matcher_choices<MatcherKind>(),
          "Matcher that searches the whole map while the robot is lost. The exact search, csm, also checks "
          "each place that csm_ga or ga finds and that would be accepted.")
      .number("start_window_m", localization.start_window_m, above(0).at_most(100), "m",
              "Half-width along x and y of the search windows from --start until a scan fits the map. Raise "
              "it if "
              "the start is known less well.")
      .angle_deg(
          "start_window_theta_deg", localization.start_window_rad, above(0).at_most(180),
          "Half-width in heading of the search windows from --start until a scan fits the map. Raise it if "
          "the start is known less well.")
      .constant("localization.search_resolution_m", search.resolution_m, between(0.005, 10))
      .constant("localization.search_travel_m", localization.search_travel_m, above(0))
      .constant("localization.context_travel_m", search.context.travel_m)
      .constant("localization.context_node_spacing_m", search.context.node_spacing_m)
      .constant("localization.context_point_spacing_m", search.context.point_spacing_m, above(0))
      .constant("localization.context_max_points", search.context.max_points, between(10, 1e6))
      .constant("localization.min_search_response", search.min_response, between(0, 1))
      .constant("localization.max_ambiguity", search.max_ambiguity, between(0, 1))
      .constant("localization.min_search_observed_share", search.min_observed_share, between(0, 1))
      .constant("localization.min_search_agree", search.min_agree, between(0, 1))
      .constant("localization.min_clear_share", search.min_clear_share, between(0, 1))
      .constant("localization.min_clear_share_alone", search.min_clear_share_alone, between(0, 1))
      .constant("localization.min_response", localization.min_response, between(0, 1))
      .constant("localization.min_agree", localization.min_agree, between(0, 1))
      .constant("localization.min_observed_share", localization.min_observed_share, between(0, 1))
      .constant("localization.window_m", localization.window_m, above(0).at_most(100))
      .constant("localization.window_theta_deg", localization.window_rad, above(0).at_most(180))
      .constant("localization.prior_sigma_m", localization.prior_sigma_m, above(0))
      .constant("localization.prior_sigma_theta_deg", localization.prior_sigma_rad, above(0).at_most(180))
      .constant("localization.max_misfit_m", localization.max_misfit_m)
      .constant("localization.max_misfit_s", localization.max_misfit_s);
}

}  // namespace psi_slam
