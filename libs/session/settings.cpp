// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings.h"

#include <string>
#include <utility>
#include <vector>

#include "config/ini_file.h"
#include "config/settings_text.h"
#include "frames/laser_readings.h"
#include "psi_slam/version.h"
#include "session/settings_parts.h"

namespace psi_slam {

void describe_refinement(OptionTable& table, RefinementOptions& refinement) {
  table
      .integer("refine_max_iterations", refinement.max_iterations, between(0, 1000), "iterations",
               "Largest number of Levenberg-Marquardt iterations that refine a match below the cell size. 0 "
               "keeps the best pose of the grid search.")
      .number("refine_score_sigma", refinement.score_sigma, above(0).at_most(100), "",
              "Standard deviation of a point's score in the refinement of a match. A larger value trusts the "
              "scan less.")
      .number("refine_converged_step_m", refinement.converged_step_m, above(0).at_most(1), "m",
              "The refinement of a match ends when its step is shorter than this.")
      .number(
          "refine_max_shift_m", refinement.max_shift_m, above(0).at_most(10), "m",
          "A refinement that moves the match farther than this has reached another peak and is discarded.");
}

namespace {

void describe_log(OptionTable& table, Settings& settings) {
  LogOptions& log = settings.log;
  std::vector<std::pair<std::string, BeamAngles>> conventions{
      {std::string(name_of(BeamAngles::kAuto)), BeamAngles::kAuto}};
  for (const BeamAngles angles : stated_beam_angles()) conventions.emplace_back(name_of(angles), angles);
  table.section("log", "Robot and laser: facts that the log does not state")
      .choice("beam_angles", log.beam_angles, std::move(conventions),
              "How the beams share the field of view if the log does not say. psi-slam check finds it out.")
      .optional_angle_deg(
          "field_of_view_deg", log.field_of_view_rad, above(0).at_most(360),
          "Field of view of the laser. auto: the log's value, or the usual one for its number of beams.")
      .optional_number("max_range_m", log.max_range_m, above(0), "m",
                       "Readings at or beyond this range count as no return. auto: the log's value, or 50 m.")
      .number("min_range_m", log.min_range_m, at_least(0), "m",
              "Readings below this range count as no return. Raise it if the laser sees the robot itself.")
      .flag("mirrored", log.mirrored,
            "Set this if the readings run clockwise because the laser hangs upside down.")
      .text("laser", log.laser,
            "Lasers to use: front, rear or a message name (CARMEN), a sensor label (rawlog) or a topic "
            "(ROS). Several with commas, or all. Empty: the first.")
      .text("laser_mounts", log.laser_mounts,
            "Poses of the lasers on the robot, each as NAME X Y YAW in m and degrees, separated by commas. "
            "Append mirrored if a laser hangs upside down. Empty: the log's poses.")
      .optional_number("laser_x_m", settings.laser_mount.x_m, any_number(), "m",
                       "Position of the laser ahead of the robot's centre. auto: the log's value, or 0 if "
                       "laser_y_m or laser_yaw_deg is set.")
      .optional_number("laser_y_m", settings.laser_mount.y_m, any_number(), "m",
                       "Position of the laser to the left of the robot's centre. auto: the log's value, or 0 "
                       "if laser_x_m or laser_yaw_deg is set.")
      .optional_angle_deg("laser_yaw_deg", settings.laser_mount.yaw_rad, between(-360, 360),
                          "Direction of the laser, counter-clockwise from straight ahead. auto: the log's "
                          "value, or 0 if laser_x_m or laser_y_m is set.")
      .optional_number("sweep_time_s", log.sweep_time_s, between(0, 1), "s",
                       "Time from the first to the last beam of a scan. The scan is corrected for the "
                       "robot's motion during this time. auto: the log's value; 0: no correction.")
      .text("scan_topic", log.scan_topic,
            "ROS bags: topic of the scans. Several with commas, or all. Empty: log.laser, or the only topic "
            "of scans.")
      .text("odometry_topic", log.odometry_topic,
            "ROS bags: topic of the odometry, or /tf. Empty: the only topic of odometry, or /tf.")
      .text("odom_frame", log.odom_frame,
            "ROS bags: frame that odometry is relative to. Empty: the nearest frame above the laser with "
            "odom in its name.")
      .text("base_frame", log.base_frame,
            "ROS bags: frame of the robot. Empty: the child frame of the odometry.")
      .integer("every_nth_scan", log.every_nth_scan, at_least(1), "scans",
               "Maps only every n-th scan: 1 maps every scan, 2 every second one.");
}

void describe_front_end(OptionTable& table, FrontEndOptions& front_end) {
  table.section("front_end", "Matching each scan with the active local map")
      .number("min_range_m", front_end.scan.min_range_m, at_least(0), "m",
              "Returns nearer than this are not matched.")
      .number("max_range_m", front_end.scan.max_range_m, above(0), "m",
              "Returns farther than this are not matched.")
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
      .number("min_response", front_end.min_response, between(0, 1), "",
              "Least response of a match. A scan that matches worse keeps its predicted pose.")
      .number("prior_sigma_m", front_end.prior_sigma_m, above(0).at_most(100), "m",
              "Standard deviation of the predicted position. The prediction fixes the pose where the scan "
              "does not, as along a corridor.")
      .angle_deg("prior_sigma_theta_deg", front_end.prior_sigma_rad, above(0).at_most(180),
                 "Standard deviation of the predicted heading. The prediction fixes the heading where the "
                 "scan does not.")
      .number("prior_per_metre", front_end.prior_per_metre, at_least(0).at_most(100), "",
              "Metres added to prior_sigma_m for each metre that the robot moved since the last scan.")
      .number(
          "prior_theta_per_turn", front_end.prior_per_radian, at_least(0).at_most(100), "",
          "Degrees added to prior_sigma_theta_deg for each degree that the robot turned since the last scan.")
      .number("prior_per_surprise", front_end.prior_per_surprise, at_least(0).at_most(100), "",
              "Growth of prior_sigma_m and prior_sigma_theta_deg for each metre or degree by which odometry "
              "differs from the robot's last motion.")
      .number("prediction_share", front_end.prediction_share, between(0, 1), "",
              "The refined prediction is preferred to the searched pose if it reaches this share of its "
              "response.")
      .number("held_share", front_end.held_share, between(0, 1), "",
              "A correction is doubtful if the pose predicted by odometry reaches this share of the matched "
              "pose's response.")
      .number("max_doubtful_correction_m", front_end.max_doubtful_correction_m, at_least(0).at_most(100), "m",
              "Largest sum of doubtful corrections, as a person walking ahead causes them. A correction "
              "beyond it "
              "is not applied.")
      .number("doubtful_correction_travel_m", front_end.doubtful_correction_travel_m, above(0).at_most(1000),
              "m", "Travel over which the sum of doubtful corrections decays to 37 %.")
      .number("odometry_sigma_m", front_end.odometry_sigma_m, above(0).at_most(10), "m",
              "Standard deviation of odometry's position from scan to scan. It enters the covariance of the "
              "poses.")
      .angle_deg("odometry_sigma_theta_deg", front_end.odometry_sigma_rad, above(0).at_most(180),
                 "Standard deviation of odometry's heading from scan to scan. It enters the covariance of "
                 "the poses.")
      .number("odometry_sigma_per_metre", front_end.odometry_sigma_per_metre, at_least(0).at_most(10), "",
              "Metres added to odometry_sigma_m for each metre moved.")
      .number("odometry_sigma_theta_per_turn", front_end.odometry_sigma_per_radian, at_least(0).at_most(10),
              "", "Degrees added to odometry_sigma_theta_deg for each degree turned.")
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
              "Longer beams are cut at this range and mark only free space in local maps.")
      .integer("nodes", front_end.nodes_per_local_map, between(2, 60000), "nodes",
               "A local map is finished after this many nodes. The next one begins at half of them.")
      .number("travel_m", front_end.local_map_travel_m, above(0), "m",
              "A local map is finished when the robot has travelled this far in it.")
      .number("max_unmatched_travel_m", front_end.max_unmatched_travel_m, above(0), "m",
              "Travel without a match, over at least two scans, after which all local maps are finished. A "
              "covered laser causes this.");
}

void describe_map(OptionTable& table, GridMapOptions& map) {
  table.section("map", "The map and its output files")
      .number("resolution_m", map.resolution_m, between(0.005, 10), "m", "Side length of a cell of the map.")
      .number("max_range_m", map.max_range_m, above(0), "m",
              "Longer beams are cut at this range and mark only free space in the map.")
      .number("margin_m", map.margin_m, at_least(0).at_most(1000), "m",
              "Width of the unknown space around everything that was observed.")
      .integer("max_cells", map.max_cells, between(10'000, 1'000'000'000), "cells",
               "Largest number of cells. A larger map gets coarser cells.");
}

void describe_map_files(OptionTable& table, MapFileOptions& files) {
  table.flag("write_png", files.png, "Writes map.png, an image of the map.")
      .flag("write_ros", files.ros, "Writes map.yaml and map.pgm for map_server of ROS 1 and nav2.")
      .flag("write_mrpt", files.mrpt, "Writes map.gridmap.gz and map.simplemap.gz for the programs of MRPT.")
      .flag("write_svg", files.svg, "Writes map.svg: walls and path as lines, at print_scale.")
      .flag("write_dxf", files.dxf, "Writes map.dxf: walls and path for CAD programs, in metres.")
      .flag("write_print", files.print, "Writes map_print.png, an image that prints at print_scale.")
      .flag("write_geotiff", files.geotiff, "Writes map.tif for geographic information systems.")
      .number("print_scale", files.print_scale, above(0).at_most(1e6), "",
              "Scale of map_print.png and map.svg. 100 means 1:100, one centimetre of paper for one metre.")
      .integer("print_dpi", files.print_dpi, between(1, 10'000), "dpi",
               "Resolution of map_print.png. It is lowered if the image would exceed 150 million pixels.")
      .number("line_tolerance_m", files.lines.tolerance_m, at_least(0).at_most(10), "m",
              "Largest deviation of the lines in map.svg and map.dxf from the outlines of the cells.")
      .number("min_wall_m", files.lines.min_wall_m, at_least(0).at_most(100), "m",
              "Occupied spots smaller than this are left out of map.svg and map.dxf.")
      .integer(
          "epsg", files.earth.epsg, between(0, 1'000'000), "",
          "EPSG code of the projected coordinate system of map.tif, in metres. 0: the map's own coordinates.")
      .number("origin_easting_m", files.earth.easting_m, between(-1e9, 1e9), "m",
              "Easting of the map's origin in the coordinate system of map.tif.")
      .number("origin_northing_m", files.earth.northing_m, between(-1e9, 1e9), "m",
              "Northing of the map's origin in the coordinate system of map.tif.")
      .angle_deg("origin_heading_deg", files.earth.heading_rad, between(-360, 360),
                 "Direction of the map's x axis in map.tif, counter-clockwise from east.");
}

void describe_localization(OptionTable& table, LocalizerOptions& localization) {
  GlobalSearchOptions& search = localization.search;
  table.section("localization", "psi-slam localize: finding and tracking a robot in a finished map")
      .choice("matcher", search.matcher, matcher_choices<MatcherKind>(),
              "Matcher that searches the whole map while the robot is lost.")
      .number("search_resolution_m", search.resolution_m, between(0.005, 10), "m",
              "Cell size for searching the whole map. Larger cells of the map itself are kept.")
      .number("search_travel_m", localization.search_travel_m, above(0), "m",
              "While lost: travel from one search of the whole map to the next.")
      .number("context_travel_m", search.context.travel_m, at_least(0), "m",
              "The whole map is searched with all scans of this much travel.")
      .number("context_node_spacing_m", search.context.node_spacing_m, at_least(0), "m",
              "Search of the whole map: least travel between the scans that are searched together.")
      .number("context_point_spacing_m", search.context.point_spacing_m, above(0), "m",
              "Search of the whole map: one point is kept in each square of this side length.")
      .number("min_search_response", search.min_response, between(0, 1), "",
              "Search of the whole map: least response of a place.")
      .number("max_ambiguity", search.max_ambiguity, between(0, 1), "",
              "Search of the whole map: largest response of another place, as a share of the best. A higher "
              "value needs more searches to agree.")
      .number("min_search_observed_share", search.min_observed_share, between(0, 1), "",
              "Search of the whole map: least share of the points that lie in observed space.")
      .number("min_search_agree", search.min_agree, between(0, 1), "",
              "Search of the whole map: least share of the points in observed space that lie on walls.")
      .number("min_clear_share", search.min_clear_share, between(0, 1), "",
              "Search of the whole map: least share of the beams that pass through no wall.")
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
              "Half-width along x and y of the first search window, centred on --start.")
      .angle_deg("start_window_theta_deg", localization.start_window_rad, above(0).at_most(180),
                 "Half-width in heading of the first search window, centred on --start.")
      .number("max_misfit_m", localization.max_misfit_m, at_least(0), "m",
              "The robot counts as lost after more than this much travel without a fitting scan.")
      .number("max_misfit_s", localization.max_misfit_s, at_least(0), "s",
              "The robot counts as lost after more than this time without a fitting scan.");
}

void describe_run(OptionTable& table, RunOptions& run) {
  table.section("run", "How the program runs")
      .integer("seed", run.seed, any_number(), "", "Seed of all random numbers. Equal seeds give equal maps.")
      .integer("threads", run.threads, between(0, 1024), "threads",
               "Number of threads. 0: one for each processor. The results do not depend on it.");
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
  table.alias("last_pass", "final_search")
      .alias("front_end.max_strain_m", "front_end.max_doubtful_correction_m")
      .alias("front_end.strain_travel_m", "front_end.doubtful_correction_travel_m")
      .alias("consensus.max_rival_share", "consensus.max_other_place_share");
}

void BoundSettings::load(const std::filesystem::path& config, const std::vector<std::string>& assignments) {
  if (!config.empty()) apply(read_ini(config), table);
  for (const std::string& assignment : assignments) apply_override(assignment, table);
}

std::string settings_file_text(const OptionTable& table) {
  return "; Settings of psi-slam " PSI_SLAM_VERSION
         ". Lines that begin with a semicolon are comments.\n"
         "; An option that the file does not set keeps its default.\n\n" +
         dump(table);
}

std::string settings_file_text(const Settings& settings) {
  BoundSettings bound;
  bound.settings = settings;
  return settings_file_text(bound.table);
}

}  // namespace psi_slam
