// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings.h"

#include <string>
#include <utility>
#include <vector>

#include "session/settings_parts.h"

namespace psi_slam {

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
      .text(
          "laser", log.laser,
          "which laser: front, rear or a message's name (CARMEN), a sensor's label (rawlog), a topic (ROS); "
          "several with commas, or all, at once; empty: the first")
      .text("laser_mounts", log.laser_mounts,
            "lasers on the robot, each NAME X Y YAW in m and degrees, with mirrored behind it if it hangs "
            "upside "
            "down, and commas between them; empty: the log's own")
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
      .text(
          "scan_topic", log.scan_topic,
          "ROS bags: the topic of the scans, several with commas, or all; empty: log.laser, or the only one")
      .text("odometry_topic", log.odometry_topic,
            "ROS bags: the topic of the odometry, or /tf; empty: the only one of its type, else /tf")
      .text("odom_frame", log.odom_frame,
            "ROS bags: the frame that odometry is told in; empty: the one above the laser that is named so")
      .text("base_frame", log.base_frame,
            "ROS bags: the robot's frame, which odometry moves; empty: the odometry's own child frame")
      .integer("every_nth_scan", log.every_nth_scan, at_least(1), "scans",
               "1 maps every scan, 2 every second one, and so on");
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
      .number("max_strain_m", front_end.max_doubtful_correction_m, at_least(0).at_most(100), "m",
              "pulls in doubt (by a person who walks ahead) that add up to more than this are not followed")
      .number("strain_travel_m", front_end.doubtful_correction_travel_m, above(0).at_most(1000), "m",
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
  describe_loops(table, settings.mapper);
  describe_map(table, settings.map);
  describe_map_files(table, settings.map_files);
  describe_localization(table, settings.localization);
  describe_run(table, settings.run);
}

}  // namespace psi_slam
