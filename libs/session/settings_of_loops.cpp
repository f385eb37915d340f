// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings_parts.h"

#include <string>

namespace psi_slam {
namespace {

void describe_loop_closure(OptionTable& table, MapperOptions& mapper) {
  LoopClosureOptions& loops = mapper.loop_closure;
  MatcherOptions& matcher = mapper.loop_matcher;
  LoopCandidateOptions& candidates = loops.candidates;
  auto choices = matcher_choices<std::optional<MatcherKind>>();
  choices.emplace_back("adaptive", std::nullopt);
  table.section("loop_closure", "Finding places seen before")
      .flag("enabled", mapper.close_loops, "without, the map is the front end's alone")
      .choice("matcher", mapper.matcher, choices,
              "the window is searched exhaustively, in part, genetically or as the factor Psi says")
      .number("window_x_m", candidates.max_window.x_m, above(0).at_most(100), "m",
              "largest half-width of the search window around the prediction, along x")
      .number("window_y_m", candidates.max_window.y_m, above(0).at_most(100), "m", "the same along y")
      .angle_deg("window_theta_deg", candidates.max_window.theta_rad, above(0).at_most(180),
                 "the same in heading")
      .number("min_window_m", candidates.min_window_m, above(0).at_most(100), "m",
              "smallest half-width along x and y")
      .angle_deg("min_window_theta_deg", candidates.min_window_rad, above(0).at_most(180),
                 "the same in heading")
      .number("window_sigmas", candidates.window_sigmas, above(0).at_most(100), "",
              "between the two, the window covers this many standard deviations of the prediction")
      .number("reach_m", candidates.reach_m, at_least(0).at_most(1000), "m",
              "a local map is tried when one of its nodes is at most this far from the window")
      .number("min_travel_m", candidates.min_travel_m, at_least(0), "m",
              "and the robot has travelled this far since it left it: nearer ones share their scans")
      .number("attempt_distance_m", loops.attempt_distance_m, at_least(0), "m",
              "loops are looked for once in so much travel")
      .number("context_travel_m", loops.context.travel_m, at_least(0).at_most(1000), "m",
              "wide windows are searched with the scans of so much of the path, not with one alone")
      .number("context_node_spacing_m", loops.context.node_spacing_m, at_least(0).at_most(1000), "m",
              "of these, scans nearer to each other along the path are left out")
      .number("context_point_spacing_m", loops.context.point_spacing_m, above(0).at_most(10), "m",
              "and their points are thinned to one a square of this size")
      .number("distinct_m", matcher.distinct_m, above(0).at_most(100), "m",
              "another peak of the response is distinct when it lies this far away along x or y")
      .angle_deg("distinct_deg", matcher.distinct_rad, above(0).at_most(180), "or is turned by this much")
      .number("ambiguity_floor", matcher.ambiguity_floor, between(0, 1), "",
              "peaks below this share of the best response are not looked for")
      .number("min_sigma_m", matcher.min_sigma_m, above(0).at_most(100), "m",
              "bounds of a match's standard deviations, from here")
      .number("max_sigma_m", matcher.max_sigma_m, above(0).at_most(1000), "m", "up to here");
  describe_refinement(table, matcher.refinement);
}

void describe_psi(OptionTable& table, PsiOptions& psi) {
  table.section("psi", "The factor Psi, by which loop_closure.matcher = adaptive chooses")
      .number(
          "psi_1", psi.psi_1, any_number(), "",
          "up to here csm searches for loops, above it csm_ga; below 0: never csm, for Psi is never negative")
      .number("psi_2", psi.psi_2, any_number(), "", "from here on ga")
      .integer("window_frames", psi.window_frames, between(1, 1'000'000), "nodes",
               "loops are counted over so many nodes before: the K of equation 13")
      .number("eta_max", psi.eta_max, at_least(1), "",
              "bound of eta, path over distance from the start, for a robot that comes back there");
}

void describe_paper_genetic(OptionTable& table, PaperGeneticOptions& paper) {
  table
      .integer("paper_population", paper.population, between(2, 10'000), "poses",
               "variant paper: of each generation")
      .integer("paper_generations", paper.generations, between(1, 1000), "generations",
               "variant paper: how many")
      .number("paper_crossover_rate", paper.crossover_rate, between(0, 1), "",
              "variant paper: share of the pairs that are crossed at two points")
      .number("paper_mutation_rate", paper.mutation_rate, between(0, 1), "",
              "variant paper: chance of each bit to flip");
}

void describe_genetic(OptionTable& table, GeneticOptions& genetic) {
  MemeticGeneticOptions& memetic = genetic.memetic;
  table.section("genetic", "The genetic search of the matchers csm_ga and ga")
      .choice("variant", genetic.variant,
              {{"memetic", GeneticVariant::kMemetic}, {"paper", GeneticVariant::kPaper}},
              "with local search and all options below, or as in the paper, with those of paper_*")
      .integer("population", memetic.population, between(2, 10'000), "tiles",
               "of each generation: a tile is a heading and a block of shifts")
      .integer("children", memetic.children, between(1, 10'000), "tiles", "born in each generation")
      .integer("elite", memetic.elite, between(0, 10'000), "tiles",
               "best ones kept from generation to generation; 0: none")
      .integer("generations", memetic.generations, between(0, 10'000), "generations", "at most")
      .integer("patience", memetic.patience, between(0, 10'000), "generations",
               "stop after so many without a better one; 0: never")
      .number("crossover_rate", memetic.crossover_rate, between(0, 1), "",
              "share of the children with two parents")
      .number("mutation_rate", memetic.mutation_rate, between(0, 1), "", "chance of each bit to flip")
      .flag("gray_code", memetic.gray_code, "a step in space is one bit; without, the paper's binary code")
      .flag("niches", memetic.niches, "one individual a neighbourhood, so that two corridors both survive")
      .flag("remember", memetic.remember, "a chromosome met before is not scored again")
      .flag("pooled_fitness", memetic.pooled_fitness, "it evolves on the max-pooled grid first")
      .integer("descents", memetic.descents, between(0, 10'000), "tiles",
               "best ones of a generation that descend along the heading")
      .integer("polished", memetic.polished, between(0, 10'000), "poses",
               "best ones whose neighbourhood is searched exactly at the end")
      .flag("seed_coarse", memetic.seed_coarse,
            "the first generation comes of a sparse coarse search; without, it is random")
      .integer("seeds", memetic.seeds, between(1, 10'000), "tiles", "at most, of that search")
      .integer("seed_points", memetic.seed_points, between(1, 1'000'000), "points",
               "of the scan, that it looks at")
      .integer("heading_stride", memetic.heading_stride, between(1, 1000), "headings",
               "it, and the coarse stage of csm_ga, look at one heading in so many")
      .integer("coarse_cells", genetic.coarse.cells, between(1, 100'000), "cells",
               "of csm_ga: the best ones that the genetic search looks into");
  describe_paper_genetic(table, genetic.paper);
}

void describe_verification(OptionTable& table, LoopVerificationOptions& verification) {
  table.section("verification", "Which loops are believed: one false loop ruins a map")
      .number("wide_window_m", verification.wide_window_m, at_least(0), "m",
              "windows of a larger half-width are wide: many things in them look alike")
      .number("min_response", verification.min_response, between(0, 1), "",
              "least response of a scan in a narrow window")
      .number("min_context_response", verification.min_context_response, between(0, 1), "",
              "least response of a scan and those before it in a wide window")
      .number("max_ambiguity", verification.max_ambiguity, between(0, 1), "",
              "greatest response of another distinct peak in a narrow window, as a share of the best")
      .number("max_sigma_m", verification.max_sigma_m, above(0), "m",
              "greatest standard deviation of the matched position")
      .number("min_observed_share", verification.min_observed_share, between(0, 1), "",
              "least share of the scan's points in space that the local map has seen; in wide windows not "
              "asked for")
      .number("min_neighbours_agree", verification.min_neighbours_agree, between(0, 1), "",
              "least share of the neighbouring scans' points that fit the local map")
      .number("min_reverse_agree", verification.min_reverse_agree, between(0, 1), "",
              "least share of the local map's points that fit what the scan sees")
      .number("neighbourhood_m", verification.neighbourhood_m, at_least(0), "m",
              "scans this far along the path, before and after, are neighbours");
}

void describe_consensus(OptionTable& table, LoopConsensusOptions& consensus) {
  table.section("consensus", "Loops found in wide windows wait until others agree with them")
      .number("memory_m", consensus.memory_m, above(0), "m",
              "matches farther back along the path no longer count")
      .number("same_place_m", consensus.same_place_m, above(0).at_most(100), "m",
              "matches agree when they put the robot this near to each other")
      .angle_deg("same_heading_deg", consensus.same_heading_rad, above(0).at_most(180),
                 "and turn it by no more than this")
      .number("min_span_m", consensus.min_span_m, at_least(0), "m",
              "least way between the first and the last match that agree")
      .number(
          "min_weight", consensus.min_weight, above(0), "",
          "least weight of those that agree; a match weighs the more, the less ambiguous it is, at most 1")
      .number("max_rival_share", consensus.max_rival_share, between(0, 1), "",
              "greatest weight of any other place, as a share of theirs");
}

void describe_kernel(OptionTable& table, const std::string& constraints, const std::string& whose,
                     RobustKernel& kernel) {
  using Type = RobustKernel::Type;
  table
      .choice(constraints + "_kernel", kernel.type,
              {{"none", Type::kNone},
               {"huber", Type::kHuber},
               {"cauchy", Type::kCauchy},
               {"dynamic_scaling", Type::kDynamicScaling},
               {"geman_mcclure", Type::kGemanMcClure}},
              "robust kernel of the constraints " + whose)
      .number(constraints + "_kernel_width", kernel.width, above(0), "sigma",
              "errors beyond this weigh less, in standard deviations");
}

void describe_pose_graph(OptionTable& table, MapperOptions& mapper) {
  PoseAdjustmentOptions& solver = mapper.pose_graph;
  table.section("pose_graph", "The graph of poses and its optimisation")
      .number("local_map_sigma_m", mapper.local_map_sigma_m, above(0), "m",
              "standard deviation of a node in a local map, on top of the front end's covariance")
      .angle_deg("local_map_sigma_theta_deg", mapper.local_map_sigma_rad, above(0).at_most(180),
                 "the same in heading")
      .number("loop_sigma_m", mapper.loop_sigma_m, above(0), "m",
              "standard deviation of a loop, on top of its match's own")
      .angle_deg("loop_sigma_theta_deg", mapper.loop_sigma_rad, above(0).at_most(180), "the same in heading")
      .number("max_loop_chi", mapper.max_loop_chi, above(0), "sigma",
              "a loop that the finished graph contradicts by more is switched off");
  describe_kernel(table, "local_map", "of nodes to their local maps", solver.local_map_kernel);
  describe_kernel(table, "loop", "of loops", solver.loop_kernel);
  table
      .integer("max_iterations", solver.max_iterations, between(1, 10000), "iterations",
               "most steps of an optimisation")
      .number("relative_tolerance", solver.relative_tolerance, at_least(0).below(1), "",
              "it ends when the error can fall by no more than this share of itself")
      .number("absolute_tolerance", solver.absolute_tolerance, at_least(0), "", "or by no more than this")
      .number("initial_lambda", solver.initial_lambda, at_least(0), "",
              "damping of the first step; 0 is Gauss-Newton");
}

void describe_final_search(OptionTable& table, FinalSearchOptions& final_search) {
  table.section("last_pass", "After the last scan: all pairs near each other once more")
      .integer("passes", final_search.passes, between(0, 100), "passes",
               "how often; 0 leaves the map as the last scan left it")
      .number("window_m", final_search.window_m, above(0).at_most(100), "m", "half-width of the search windows")
      .angle_deg("window_theta_deg", final_search.window_rad, above(0).at_most(180), "the same in heading")
      .number("reach_m", final_search.reach_m, at_least(0).at_most(1000), "m",
              "a local map is tried when one of its nodes is at most this far")
      .number("travel_m", final_search.travel_m, at_least(0), "m",
              "of all nodes in so much travel one is matched; 0: every node");
}

void describe_joint_refinement(OptionTable& table, JointRefinementOptions& refinement) {
  SurfaceAlignmentOptions& alignment = refinement.alignment;
  table
      .section("joint_refinement",
               "At the very end, where loops are closed: every scan laid on the surfaces that the scans near "
               "it saw")
      .integer("rounds", refinement.rounds, between(0, 100), "rounds", "how often; 0 leaves it out")
      .integer("references", refinement.references, between(1, 1000), "nodes",
               "whose scans one scan is laid on, at most; those nearest to it")
      .number("reach_m", refinement.reach_m, above(0).at_most(100), "m", "how far they may be")
      .angle_deg("max_turn_deg", refinement.max_turn_rad, above(0).at_most(180), "how far turned")
      .integer("neighbours", alignment.neighbours, between(1, 100), "points",
               "of those surfaces, nearest to a point of the scan, whose mean it is compared with")
      .number("max_distance_m", alignment.max_distance_m, above(0).at_most(10), "m",
              "points farther apart are of two surfaces")
      .angle_deg("max_normal_turn_deg", alignment.max_turn_rad, above(0).at_most(80),
                 "as are those whose normals differ by more")
      .number("kernel_m", alignment.kernel_m, above(0).at_most(10), "m",
              "residual at which a point has lost three quarters of its weight")
      .number("prior_sigma_m", alignment.prior_sigma_m, above(0).at_most(10), "m",
              "how far the optimised pose may be off")
      .angle_deg("prior_sigma_theta_deg", alignment.prior_sigma_rad, above(0).at_most(180),
                 "the same in heading")
      .integer("iterations", alignment.iterations, between(1, 100), "iterations", "of Gauss-Newton, a scan")
      .integer("min_points", alignment.min_points, between(1, 1000000), "points",
               "of a scan near surfaces; with fewer it stays where it was");
}

}  // namespace

void describe_loops(OptionTable& table, MapperOptions& mapper) {
  describe_loop_closure(table, mapper);
  describe_psi(table, mapper.psi);
  describe_genetic(table, mapper.genetic);
  describe_verification(table, mapper.loop_closure.verification);
  describe_consensus(table, mapper.loop_consensus);
  describe_pose_graph(table, mapper);
  describe_final_search(table, mapper.final_search);
  describe_joint_refinement(table, mapper.joint_refinement);
}

}  // namespace psi_slam
