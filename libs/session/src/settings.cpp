// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/session/settings.h"

#include <string>
#include <utility>
#include <vector>

namespace psi_slam {
namespace {

void describe_log(OptionTable& table, Settings& settings) {
  LogOptions& log = settings.log;
  std::vector<std::pair<std::string, BeamAngles>> conventions{
      {std::string(name_of(BeamAngles::kAuto)), BeamAngles::kAuto}};
  for (const BeamAngles angles : stated_beam_angles()) conventions.emplace_back(name_of(angles), angles);
  table.section("log", "Robot and sensor: what the log does not say itself")
      .choice("beam_angles", log.beam_angles, std::move(conventions),
              "how the beams share the field of view where the log does not say; psi-slam check finds out")
      .optional_angle_deg(
          "field_of_view_deg", log.field_of_view_rad, above(0).at_most(360),
          "field of view of the laser; auto: the log's own, or the usual one of that many beams")
      .optional_number("max_range_m", log.max_range_m, above(0), "m",
                       "readings from here on are no returns; auto: the log's own, or 50")
      .number("min_range_m", log.min_range_m, at_least(0), "m",
              "readings below are no returns: a robot that sees its own bumper")
      .flag("mirrored", log.mirrored, "the readings run clockwise: a laser that hangs upside down")
      .text("laser", log.laser,
            "which laser: front, rear or a message's name (CARMEN), a sensor's label (rawlog); empty: the "
            "first")
      .optional_number(
          "laser_x_m", settings.laser_mount.x_m, any_number(), "m",
          "the laser on the robot, ahead of its centre; auto: the log's own, or 0 if another of the "
          "three is given")
      .optional_number("laser_y_m", settings.laser_mount.y_m, any_number(), "m", "the same to the left")
      .optional_angle_deg("laser_yaw_deg", settings.laser_mount.yaw_rad, between(-360, 360),
                          "where it looks, counter-clockwise from straight ahead")
      .optional_number(
          "sweep_time_s", log.sweep_time_s, between(0, 1), "s",
          "from the first beam of a scan to its last: the motion meanwhile is taken out; auto: what "
          "the log says, 0 leaves scans alone")
      .text("scan_topic", log.scan_topic, "ROS bags: the topic of the scans; empty: the only one of its type")
      .text("odometry_topic", log.odometry_topic,
            "ROS bags: the topic of the odometry, or /tf; empty: the only one of its type, else /tf")
      .text("odom_frame", log.odom_frame,
            "ROS bags: the frame that odometry is told in; empty: the one above the laser that is named so")
      .text("base_frame", log.base_frame,
            "ROS bags: the robot's frame, which odometry moves; empty: the odometry's own child frame")
      .integer("every_nth_scan", log.every_nth_scan, at_least(1), "scans",
               "1 maps every scan, 2 every second one, and so on");
}

void describe_refinement(OptionTable& table, RefinementOptions& refinement) {
  table
      .integer("refine_max_iterations", refinement.max_iterations, between(0, 1000), "iterations",
               "Levenberg-Marquardt steps below a cell; 0 keeps the cell")
      .number("refine_score_sigma", refinement.score_sigma, above(0).at_most(100), "",
              "standard deviation of a point's score from 1: larger trusts the scan less")
      .number("refine_converged_step_m", refinement.converged_step_m, above(0).at_most(1), "m",
              "steps below this end the refinement")
      .number("refine_max_shift_m", refinement.max_shift_m, above(0).at_most(10), "m",
              "a refinement that leads farther than this is dropped: it found another peak");
}

void describe_front_end(OptionTable& table, FrontEndOptions& front_end) {
  table.section("front_end", "Matching each scan with the active local map")
      .number("min_range_m", front_end.scan.min_range_m, at_least(0), "m",
              "returns nearer than this are not matched")
      .number("max_range_m", front_end.scan.max_range_m, above(0), "m",
              "returns farther than this are not matched")
      .number("point_spacing_m", front_end.scan.spacing_m, at_least(0).at_most(10), "m",
              "points of a scan nearer to each other than this are thinned")
      .number("window_m", front_end.window_m, above(0).at_most(20), "m",
              "half-width of the search window of a robot that stands still")
      .angle_deg("window_theta_deg", front_end.window_rad, above(0).at_most(180), "the same in heading")
      .number("window_per_metre", front_end.window_per_metre, at_least(0).at_most(100), "",
              "added to window_m for each metre that odometry moved since the last scan")
      .number("window_theta_per_turn", front_end.window_per_radian, at_least(0).at_most(100), "",
              "added to window_theta_deg for each degree that odometry turned")
      .angle_deg("window_theta_per_metre_deg", front_end.window_rad_per_metre, at_least(0).at_most(180),
                 "added to window_theta_deg for each metre that odometry moved")
      .number("max_window_m", front_end.max_window_m, above(0).at_most(20), "m",
              "the window never grows beyond this half-width")
      .angle_deg("max_window_theta_deg", front_end.max_window_rad, above(0).at_most(180),
                 "the same in heading")
      .number("min_response", front_end.min_response, between(0, 1), "",
              "a match below this is not believed: odometry's prediction stands")
      .number("prior_sigma_m", front_end.prior_sigma_m, above(0).at_most(100), "m",
              "standard deviation of the prediction that holds the pose where the scan does not (corridors)")
      .angle_deg("prior_sigma_theta_deg", front_end.prior_sigma_rad, above(0).at_most(180),
                 "the same in heading")
      .number("prior_per_metre", front_end.prior_per_metre, at_least(0).at_most(100), "",
              "added to prior_sigma_m for each metre that odometry moved")
      .number("prior_theta_per_turn", front_end.prior_per_radian, at_least(0).at_most(100), "",
              "added to prior_sigma_theta_deg for each degree that odometry turned")
      .number("prior_per_surprise", front_end.prior_per_surprise, at_least(0).at_most(100), "",
              "added to both for each metre or degree that odometry differs from a steady motion")
      .number("prediction_share", front_end.prediction_share, between(0, 1), "",
              "the prediction, refined, is preferred if it scores this share of the searched pose")
      .number("held_share", front_end.held_share, between(0, 1), "",
              "a pull away from odometry is in doubt if the pose without it scores this share of the match")
      .number("max_strain_m", front_end.max_strain_m, at_least(0).at_most(100), "m",
              "pulls in doubt (by a person who walks ahead) that add up to more than this are not followed")
      .number("strain_travel_m", front_end.strain_travel_m, above(0).at_most(1000), "m",
              "pulls in doubt are forgotten over this much travel")
      .number("odometry_sigma_m", front_end.odometry_sigma_m, above(0).at_most(10), "m",
              "odometry's noise from scan to scan, for the covariance of the poses")
      .angle_deg("odometry_sigma_theta_deg", front_end.odometry_sigma_rad, above(0).at_most(180),
                 "the same in heading")
      .number("odometry_sigma_per_metre", front_end.odometry_sigma_per_metre, at_least(0).at_most(10), "",
              "added to odometry_sigma_m for each metre moved")
      .number("odometry_sigma_theta_per_turn", front_end.odometry_sigma_per_radian, at_least(0).at_most(10),
              "", "added to odometry_sigma_theta_deg for each degree turned")
      .number("node_distance_m", front_end.node_distance_m, at_least(0).at_most(100), "m",
              "a scan becomes a node of the graph when the robot moved this far since the last one")
      .angle_deg("node_rotation_deg", front_end.node_rotation_rad, at_least(0).at_most(180),
                 "or turned this much");
  describe_refinement(table, front_end.refinement);
}

void describe_local_maps(OptionTable& table, FrontEndOptions& front_end) {
  LocalMapOptions& local_map = front_end.local_map;
  table.section("local_maps", "The occupancy grids that scans are matched with")
      .number("resolution_m", local_map.resolution_m, between(0.005, 1), "m", "side of a cell")
      .number("hit_probability", local_map.hit_probability, above(0.5).below(1), "",
              "of a cell being occupied, given that a beam ended in it")
      .number("miss_probability", local_map.miss_probability, above(0).below(0.5), "",
              "of a cell being occupied, given that a beam went through it")
      .number("smoothing_sigma_m", local_map.smoothing_sigma_m, above(0).at_most(5), "m",
              "how far a wall's score reaches: range noise and cell size")
      .number("max_insert_range_m", local_map.max_insert_range_m, above(0), "m",
              "longer beams are drawn up to here, as free space only")
      .integer("nodes", front_end.nodes_per_local_map, between(2, 60000), "nodes",
               "a local map ends after this many; the next begins at half of them")
      .number("travel_m", front_end.local_map_travel_m, above(0), "m",
              "or when the robot has travelled this far in it")
      .number("max_unmatched_travel_m", front_end.max_unmatched_travel_m, above(0), "m",
              "all end after two scans or more without a match and this much travel (a blind laser)");
}

void describe_loop_closure(OptionTable& table, MapperOptions& mapper) {
  LoopClosureOptions& loops = mapper.loop_closure;
  MatcherOptions& matcher = mapper.loop_matcher;
  LoopCandidateOptions& candidates = loops.candidates;
  table.section("loop_closure", "Finding places seen before")
      .flag("enabled", mapper.close_loops, "without, the map is the front end's alone")
      .choice("matcher", mapper.matcher,
              {{"csm", LoopMatcher::kCsm},
               {"csm_ga", LoopMatcher::kCsmGa},
               {"ga", LoopMatcher::kGa},
               {"adaptive", LoopMatcher::kAdaptive}},
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

void describe_last_pass(OptionTable& table, LastPassOptions& last_pass) {
  table.section("last_pass", "After the last scan: all pairs near each other once more")
      .integer("passes", last_pass.passes, between(0, 100), "passes",
               "how often; 0 leaves the map as the last scan left it")
      .number("window_m", last_pass.window_m, above(0).at_most(100), "m", "half-width of the search windows")
      .angle_deg("window_theta_deg", last_pass.window_rad, above(0).at_most(180), "the same in heading")
      .number("reach_m", last_pass.reach_m, at_least(0).at_most(1000), "m",
              "a local map is tried when one of its nodes is at most this far")
      .number("travel_m", last_pass.travel_m, at_least(0), "m",
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

void describe_map(OptionTable& table, GridMapOptions& map) {
  table.section("map", "The map that is written")
      .number("resolution_m", map.resolution_m, between(0.005, 10), "m", "side of a cell")
      .number("max_range_m", map.max_range_m, above(0), "m",
              "longer beams are drawn up to here, as free space only")
      .number("margin_m", map.margin_m, at_least(0).at_most(1000), "m",
              "of unknown space around all that was seen")
      .integer("max_cells", map.max_cells, between(10'000, 1'000'000'000), "cells",
               "a larger map gets coarser cells");
}

void describe_map_files(OptionTable& table, MapFileOptions& files) {
  table.flag("write_png", files.png, "map.png: the map to look at")
      .flag("write_ros", files.ros, "map.yaml and map.pgm: for map_server of ROS 1 and nav2")
      .flag("write_mrpt", files.mrpt, "map.gridmap.gz and map.simplemap.gz: for MRPT's programs")
      .flag("write_svg", files.svg,
            "map.svg: walls and path as lines, in millimetres of paper at print_scale")
      .flag("write_dxf", files.dxf, "map.dxf: walls and path for CAD, in metres")
      .flag("write_print", files.print, "map_print.png: a picture that prints true to scale")
      .flag("write_geotiff", files.geotiff, "map.tif: for geographic information systems")
      .number("print_scale", files.print_scale, above(0).at_most(1e6), "",
              "of map_print.png and map.svg: 100 is 1:100, a centimetre of paper for a metre")
      .integer("print_dpi", files.print_dpi, between(1, 10'000), "dpi",
               "of map_print.png; lowered where the picture had more than 150 million pixels")
      .number("line_tolerance_m", files.lines.tolerance_m, at_least(0).at_most(10), "m",
              "what lines of map.svg and map.dxf may deviate from the cells' outlines")
      .number("min_wall_m", files.lines.min_wall_m, at_least(0).at_most(100), "m",
              "of map.svg and map.dxf: occupied spots smaller than this are left out")
      .integer("epsg", files.earth.epsg, between(0, 1'000'000), "",
               "of map.tif: the projected coordinate system, in metres; 0: the map's own")
      .number("origin_easting_m", files.earth.easting_m, between(-1e9, 1e9), "m",
              "of map.tif: where the map's origin lies in that system")
      .number("origin_northing_m", files.earth.northing_m, between(-1e9, 1e9), "m", "the same to the north")
      .angle_deg("origin_heading_deg", files.earth.heading_rad, between(-360, 360),
                 "of map.tif: where the map's x axis points, counter-clockwise from east");
}

void describe_localization(OptionTable& table, LocalizerOptions& localization) {
  GlobalSearchOptions& search = localization.search;
  table.section("localization", "psi-slam localize: a robot in a finished map")
      .choice("matcher", search.matcher,
              {{"csm", MatcherKind::kCsm}, {"csm_ga", MatcherKind::kCsmGa}, {"ga", MatcherKind::kGa}},
              "that searches the whole map while the robot is lost")
      .number("search_resolution_m", search.resolution_m, between(0.005, 10), "m",
              "cells of that search, where they are larger than the map's")
      .number("search_travel_m", localization.search_travel_m, above(0), "m",
              "from one of these searches to the next")
      .number("context_travel_m", search.context.travel_m, at_least(0), "m",
              "of the way before, whose scans are looked for together")
      .number("context_node_spacing_m", search.context.node_spacing_m, at_least(0), "m",
              "scans of it nearer to each other along the way are left out")
      .number("context_point_spacing_m", search.context.point_spacing_m, above(0), "m",
              "one point of it for each square of this size")
      .number("min_search_response", search.min_response, between(0, 1), "", "least response of a place")
      .number("max_ambiguity", search.max_ambiguity, between(0, 1), "",
              "greatest response of another place of the map, as a share of the best; the nearer to 1, the "
              "more searches must agree")
      .number("min_search_observed_share", search.min_observed_share, between(0, 1), "",
              "least share of the scans' points where the map shows anything, at a place found")
      .number("min_search_agree", search.min_agree, between(0, 1), "",
              "least share of those points, on the map's walls")
      .number("min_clear_share", search.min_clear_share, between(0, 1), "",
              "least share of the beams that go through no wall at a place found")
      .number("min_response", localization.min_response, between(0, 1), "",
              "while tracking: least response of a scan")
      .number("min_agree", localization.min_agree, between(0, 1), "",
              "while tracking: least share of a scan's points, where the map shows anything, on its walls")
      .number("min_observed_share", localization.min_observed_share, between(0, 1), "",
              "while tracking: least share of a scan's points where the map shows anything")
      .number("window_m", localization.window_m, above(0).at_most(100), "m",
              "while tracking: half-width of the search window")
      .angle_deg("window_theta_deg", localization.window_rad, above(0).at_most(180), "the same in heading")
      .number("prior_sigma_m", localization.prior_sigma_m, above(0).at_most(100), "m",
              "while tracking: standard deviation of the prediction, which holds the pose where the scan "
              "does not")
      .angle_deg("prior_sigma_theta_deg", localization.prior_sigma_rad, above(0).at_most(180),
                 "the same in heading")
      .number("start_window_m", localization.start_window_m, above(0).at_most(100), "m",
              "half-width of the first window around --start")
      .angle_deg("start_window_theta_deg", localization.start_window_rad, above(0).at_most(180),
                 "the same in heading")
      .number("max_misfit_m", localization.max_misfit_m, at_least(0), "m",
              "the robot is lost when scans have not fitted for so much travel")
      .number("max_misfit_s", localization.max_misfit_s, at_least(0), "s", "or for so long");
}

void describe_run(OptionTable& table, RunOptions& run) {
  table.section("run", "How the program runs")
      .integer("seed", run.seed, any_number(), "", "of all random numbers: the same seed gives the same map")
      .integer("threads", run.threads, between(0, 1024), "threads",
               "0 is one for each processor; no result depends on it");
}

}  // namespace

void describe(OptionTable& table, Settings& settings) {
  describe_log(table, settings);
  describe_front_end(table, settings.mapper.front_end);
  describe_local_maps(table, settings.mapper.front_end);
  describe_loop_closure(table, settings.mapper);
  describe_psi(table, settings.mapper.psi);
  describe_genetic(table, settings.mapper.genetic);
  describe_verification(table, settings.mapper.loop_closure.verification);
  describe_consensus(table, settings.mapper.loop_consensus);
  describe_pose_graph(table, settings.mapper);
  describe_last_pass(table, settings.mapper.last_pass);
  describe_joint_refinement(table, settings.mapper.joint_refinement);
  describe_map(table, settings.map);
  describe_map_files(table, settings.map_files);
  describe_localization(table, settings.localization);
  describe_run(table, settings.run);
}

}  // namespace psi_slam
