// SPDX-License-Identifier: BSD-3-Clause
#include "session/settings.h"

#include <algorithm>
#include <limits>
#include <thread>
#include <utility>

#include "base/config/ini_file.h"
#include "base/config/settings_text.h"
#include "base/number_text.h"
#include "logs/frames/laser_readings.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"

namespace psi_slam {

namespace {

void describe_log(OptionTable& table, Settings& settings) {
  LogOptions& log = settings.log;
  std::vector<std::pair<std::string, BeamAngles>> conventions{
      {std::string(name_of(BeamAngles::kAuto)), BeamAngles::kAuto}};
  for (const BeamAngles angles : stated_beam_angles()) conventions.emplace_back(name_of(angles), angles);
  table.section("log", "Robot and laser: facts that the log does not state")
      .choice("beam_angles", log.beam_angles, std::move(conventions),
              "How the beams divide the field of view if the log does not state it. psi-slam check "
              "determines this.")
      .optional_angle_deg(
          "field_of_view_deg", log.field_of_view_rad, above(0).at_most(360),
          "Field of view of the laser. auto: the log's value, or the usual one for its number of beams.")
      .optional_number(
          "max_range_m", log.max_range_m, above(0), "m",
          "Readings at or beyond this range count as no return. auto: the code for no return that the "
          "readings show, otherwise the log's value, or 50 m. State the range of the laser "
          "if far walls are missing, or if the map shows fans of free space beyond the walls.")
      .number("min_range_m", log.min_range_m, between(0, 100), "m",
              "Readings below this range are neither matched nor drawn. Raise it if the laser sees the robot "
              "itself.")
      .flag("mirrored", log.mirrored,
            "Set this if the readings run clockwise because the laser hangs upside down.")
      .text("laser", log.laser,
            "Lasers to use: front, rear or a message name (CARMEN), a sensor label (rawlog) or a topic "
            "(ROS). Several with commas, or all. Empty: those with known mounts, else the first.")
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
      .choice("sweep_direction", log.sweep_direction,
              {{"auto", SweepDirection::kAuto},
               {"forward", SweepDirection::kForward},
               {"backward", SweepDirection::kBackward}},
              "Order in which the laser measures the beams of a scan. forward: the first beam first. "
              "backward: the last beam first. auto: as the scans show in turns, otherwise as the log states.")
      .choice("mask_own_body", log.mask_own_body, {{"auto", true}, {"off", false}},
              "Readings of the robot's own body. auto: ignores ranges up to 1 m that stay constant while the "
              "robot turns. off: uses all readings.")
      .text(
          "scan_topic", log.scan_topic,
          "ROS bags: topic of the scans. Several with commas, or all. Empty: log.laser, or all topics whose "
          "lasers have a known mount.")
      .text("odometry", log.odometry,
            "Odometry to use. auto: the log's odometry, or none if it has none. none: scans only. ROS bags: "
            "a topic of odometry, or /tf.")
      .optional_number("odometry_scale", log.odometry_scale, between(0.01, 100), "",
                       "True distance divided by the distance that odometry measures. auto: 1, or the "
                       "estimate of calibrate.")
      .text("scan_delay_s", log.scan_delay_s,
            "Time by which scans are stamped later than odometry, in s: one for all lasers, or NAME SECONDS "
            "for each laser, separated by commas. auto: 0, or the estimates of calibrate.")
      .flag("calibrate", log.calibrate,
            "Estimates the scale of odometry, the delay of scans and the pose of the laser from the scans "
            "before mapping, and uses what the log determines well.")
      .text("imu", log.imu,
            "Gyroscope that predicts the heading where there is no odometry. auto: the only one of the log. "
            "none: no gyroscope. Otherwise a topic (ROS) or a sensor label (rawlog).")
      .text("slice_z_m", log.slice_z_m,
            "Maps point clouds (PointCloud2 of ROS bags, 3D observations of rawlogs) instead of laser scans: "
            "the points between two heights above the floor, LOW HIGH in m. Empty: no point clouds.")
      .text("odom_frame", log.odom_frame,
            "ROS bags: frame that odometry is relative to. Empty: the nearest frame above the laser with "
            "odom in its name.")
      .text("base_frame", log.base_frame,
            "ROS bags: frame of the robot. Empty: the child frame of the odometry.")
      .integer("every_nth_scan", log.every_nth_scan, at_least(1), "scans",
               "Maps only every n-th scan: 1 maps every scan, 2 every second one.");
}

void describe_map(OptionTable& table, GridMapOptions& map) {
  table.section("map", "The map and its output files")
      .number("resolution_m", map.resolution_m, between(0.005, 10), "m", "Side length of a cell of the map.")
      .number("max_range_m", map.max_range_m, above(0), "m",
              "Longer beams are cut at this range and mark only free space in the map. The default exceeds "
              "the range of usual 2D lidars.")
      .number("no_return_clears_m", map.no_return_clears_m, at_least(0), "m",
              "Beams without return turn unknown space into free space up to this length, but not beyond the "
              "maximum range of the sensor. They remove no obstacles. 0: they mark nothing.")
      .number("margin_m", map.margin_m, at_least(0).at_most(1000), "m",
              "Width of the unknown space around everything that was observed.")
      .integer("max_cells", map.max_cells, between(10'000, 1'000'000'000), "cells",
               "Maximum number of cells. A larger map gets coarser cells.")
      .flag("keep_moving", map.keep_moving,
            "Draws people, carts and doors that moved. false: the finished map shows the newest confirmed "
            "state of each place, and doubtful states as unknown; some table legs may vanish, too.")
      .integer(
          "min_beams", map.min_beams, between(1, 3), "beams",
          "Minimum number of beams that must see an obstacle or free space. A beam counts as two if a "
          "neighbouring beam of its scan reaches as far. What fewer beams saw stays unknown: single beams "
          "through windows and past edges. 1: draws every beam.");
}

void describe_map_files(OptionTable& table, MapFileOptions& files) {
  table.flag("write_png", files.png, "Writes map.png, an image of the map.")
      .flag("write_ros", files.ros, "Writes map.yaml and map.pgm for map_server of ROS 1 and nav2.")
      .flag("write_mrpt", files.mrpt, "Writes map.gridmap.gz and map.simplemap.gz for the programs of MRPT.")
      .flag("write_svg", files.svg, "Writes map.svg: walls and path as lines, at print_scale.")
      .flag("write_dxf", files.dxf, "Writes map.dxf: walls and path for CAD programs, in metres.")
      .flag("write_geotiff", files.geotiff, "Writes map.tif for geographic information systems.")
      .flag("write_gpkg", files.gpkg,
            "Writes map.gpkg: walls, path with times, and zones for geographic information systems.")
      .number("print_scale", files.print_scale, between(0.001, 1e6), "",
              "Scale of map.svg. 100 means 1:100, one centimetre of paper for one metre.")
      .number(
          "line_tolerance_m", files.lines.tolerance_m, at_least(0).at_most(10), "m",
          "Maximum deviation of the lines in map.svg, map.dxf and map.gpkg from the outlines of the cells.")
      .number("min_wall_m", files.lines.min_wall_m, at_least(0).at_most(100), "m",
              "Occupied spots smaller than this are left out of map.svg, map.dxf and map.gpkg.")
      .integer(
          "epsg", files.earth.epsg, between(0, 1'000'000), "",
          "EPSG code of the projected coordinate system of map.tif and map.gpkg, in metres. 0: the map's own "
          "coordinates.")
      .number("origin_easting_m", files.earth.easting_m, between(-1e9, 1e9), "m",
              "Easting of the map's origin in the coordinate system of map.tif and map.gpkg.")
      .number("origin_northing_m", files.earth.northing_m, between(-1e9, 1e9), "m",
              "Northing of the map's origin in the coordinate system of map.tif and map.gpkg.")
      .angle_deg("origin_heading_deg", files.earth.heading_rad, between(-360, 360),
                 "Direction of the map's x axis in map.tif and map.gpkg, counter-clockwise from east.");
}

void describe_map_frame(OptionTable& table, MapFrameOptions& frame) {
  table
      .text("align", frame.align,
            "Turns the finished map, with all poses. none: x points ahead of the robot at its first scan. "
            "walls: most walls are parallel to the axes. An angle in degrees: turns counter-clockwise.")
      .number("origin_x_m", frame.origin_x_m, between(-1e6, 1e6), "m",
              "Coordinate x of the point of the turned map that becomes its origin.")
      .number("origin_y_m", frame.origin_y_m, between(-1e6, 1e6), "m",
              "Coordinate y of the point of the turned map that becomes its origin.");
}

void describe_prior(OptionTable& table, PriorOptions& prior) {
  table.section("prior", "A floor plan or an earlier map, with which the run is aligned")
      .text("map", prior.map,
            "File of the prior map: map.yaml with its image, map.gridmap.gz, or a floor plan in DXF. The "
            "exported map has its frame. Empty: no prior map.")
      .number("sigma_m", prior.sigma_m, between(0.001, 10), "m",
              "Standard deviation of the walls of the prior map: how well it is measured.")
      .flag("extend", prior.extend,
            "The exported map is the prior map, brought up to date: new walls are added, and walls that the "
            "run sees to be gone are removed. Walls that both maps show and places that the run does not "
            "see stay as they are in the prior map. false: the exported map shows the run alone.")
      .optional_number("metres_per_unit", prior.metres_per_unit, between(1e-6, 1000), "m",
                       "DXF: length of a unit of the drawing, such as 0.001 for millimetres. auto: as the "
                       "drawing states.")
      .text("layers", prior.layers,
            "DXF: layers with walls, separated by commas. Layers of furniture, doors and dimensions are "
            "best left out. Empty: all layers except TRAJECTORY, the path in map.dxf.");
}

void describe_live(OptionTable& table, Settings& settings) {
  table.section("live", "Mapping while the robot drives")
      .integer("latency_nodes", settings.mapper.latency_nodes, between(0, 1000), "nodes",
               "Loops found for a node correct the poses while mapping this many nodes later. Larger values "
               "leave more time to search for loops. The finished map does not depend on it.")
      .number(
          "map_period_s", settings.live.map_period_s, between(0, 3600), "s",
          "Time between two writings of map.yaml and map.pgm during a live run. 0: writes the map only at "
          "the end.")
      .number("journal_period_s", settings.live.journal_period_s, between(0.05, 60), "s",
              "Time between two writings of the journal. A crash loses the scans of this time, and those "
              "that were "
              "not yet mapped.");
}

void describe_run(OptionTable& table, RunOptions& run) {
  table.section("run", "How the program runs")
      .integer("seed", run.seed, any_number(), "", "Seed of all random numbers. Equal seeds give equal maps.")
      .integer("threads", run.threads, between(0, 1024), "threads",
               "Number of threads. 0: one for each processor. The results do not depend on it.");
}

/// Name and value of an option.
struct Named {
  const char* name;
  double value;
  bool is_angle = false;

  std::string words() const {
    return std::string(name) + " = " + (is_angle ? exact_degrees_text(value) : exact_text(value));
  }
};

void require_below(const Named& smaller, const Named& larger) {
  if (!(smaller.value < larger.value))
    throw UserError(smaller.words() + " must be less than " + larger.words());
}

void require_at_most(const Named& smaller, const Named& larger) {
  if (!(smaller.value <= larger.value))
    throw UserError(smaller.words() + " must not be more than " + larger.words());
}

// Deleted options. A settings file that has them is accepted.
constexpr const char* kObsoleteOptions[] = {"front_end.max_strain_m",
                                            "front_end.strain_travel_m",
                                            "consensus.max_rival_share",
                                            "front_end.min_range_m",
                                            "front_end.min_response",
                                            "front_end.odometry_sigma_theta_per_turn",
                                            "front_end.refine_max_iterations",
                                            "front_end.refine_max_shift_m",
                                            "front_end.prior_sigma_m",
                                            "front_end.prior_sigma_theta_deg",
                                            "front_end.prior_per_metre",
                                            "front_end.prior_theta_per_turn",
                                            "front_end.prior_per_surprise",
                                            "front_end.prediction_share",
                                            "front_end.odometry_sigma_m",
                                            "front_end.odometry_sigma_per_metre",
                                            "front_end.odometry_sigma_per_radian",
                                            "front_end.odometry_sigma_theta_deg",
                                            "front_end.odometry_sigma_theta_per_metre_deg",
                                            "front_end.odometry_sigma_theta_per_radian_deg",
                                            "loop_closure.refine_max_iterations",
                                            "loop_closure.refine_max_shift_m",
                                            "consensus.same_place_m",
                                            "consensus.same_heading_deg",
                                            "consensus.min_weight",
                                            "loop_closure.drift_per_metre",
                                            "pose_graph.local_map_sigma_m",
                                            "pose_graph.local_map_sigma_theta_deg",
                                            "pose_graph.max_loop_chi",
                                            "pose_graph.local_map_kernel",
                                            "pose_graph.local_map_kernel_width",
                                            "pose_graph.loop_kernel",
                                            "pose_graph.loop_kernel_width",
                                            "pose_graph.relative_tolerance",
                                            "pose_graph.absolute_tolerance",
                                            "pose_graph.initial_lambda",
                                            "joint_refinement.references",
                                            "joint_refinement.reach_m",
                                            "joint_refinement.max_turn_deg",
                                            "joint_refinement.neighbours",
                                            "joint_refinement.max_distance_m",
                                            "joint_refinement.max_normal_turn_deg",
                                            "joint_refinement.kernel_m",
                                            "joint_refinement.prior_sigma_m",
                                            "joint_refinement.prior_sigma_theta_deg",
                                            "joint_refinement.iterations",
                                            "joint_refinement.search_again_m",
                                            "joint_refinement.min_points",
                                            "genetic.crossover_rate",
                                            "genetic.gray_code",
                                            "genetic.niches",
                                            "genetic.remember",
                                            "genetic.pooled_fitness",
                                            "genetic.descents",
                                            "genetic.polished",
                                            "genetic.seed_coarse",
                                            "genetic.heading_stride",
                                            "genetic.coarse_cells"};

}  // namespace

void describe(OptionTable& table, Settings& settings) {
  describe_log(table, settings);
  describe_mapper(table, settings.mapper);
  describe_map(table, settings.map);
  describe_map_files(table, settings.map_files);
  describe_map_frame(table, settings.map_frame);
  describe_prior(table, settings.prior);
  describe_localization(table, settings.localization);
  describe_live(table, settings);
  describe_run(table, settings.run);
  table.alias("last_pass", "final_search").alias("log.odometry_topic", "log.odometry");
  for (const char* name : kObsoleteOptions) table.obsolete(name);
  for (const char* name : {"map.write_print", "map.print_dpi"})
    table.obsolete(name, "print map.svg, which is to scale");
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

void check_values(const Settings& settings) {
  const Named log_min{"log.min_range_m", settings.log.min_range_m};
  const Named log_max{"log.max_range_m",
                      settings.log.max_range_m.value_or(std::numeric_limits<double>::infinity())};
  require_below(log_min, log_max);
  const BackEndOptions& back_end = settings.mapper.back_end;
  require_at_most({"psi.psi_1", back_end.psi.psi_1}, {"psi.psi_2", back_end.psi.psi_2});
  // Constants that a program of research changed.
  const FrontEndOptions& front_end = settings.mapper.front_end;
  require_at_most({"front_end.window_m", front_end.window_m},
                  {"front_end.max_window_m", front_end.max_window_m});
  require_at_most({"front_end.window_theta_deg", front_end.window_rad, true},
                  {"front_end.max_window_theta_deg", front_end.max_window_rad, true});
  const LoopCandidateOptions& loops = back_end.loop_closure.candidates;
  require_at_most({"loop_closure.min_window_m", loops.min_window_m},
                  {"loop_closure.window_x_m", loops.max_window.x_m});
  require_at_most({"loop_closure.min_window_m", loops.min_window_m},
                  {"loop_closure.window_y_m", loops.max_window.y_m});
  require_at_most({"loop_closure.min_window_theta_deg", loops.min_window_rad, true},
                  {"loop_closure.window_theta_deg", loops.max_window.theta_rad, true});
  require_at_most({"final_search.window_m", back_end.final_search.window_m},
                  {"verification.wide_window_m", back_end.loop_closure.verification.wide_window_m});
  require_at_most({"loop_closure.min_sigma_m", back_end.loop_matcher.min_sigma_m},
                  {"loop_closure.max_sigma_m", back_end.loop_matcher.max_sigma_m});
  // Otherwise each waiting match would be dropped before the next one comes.
  const LoopConsensusOptions& consensus = back_end.loop_consensus;
  require_at_most({"consensus.min_span_m", consensus.min_span_m}, {"consensus.memory_m", consensus.memory_m});
  require_at_most({"loop_closure.attempt_distance_m", back_end.loop_closure.attempt_distance_m},
                  {"consensus.memory_m", consensus.memory_m});
  check_log_options(log_options(settings));
  const std::string& align = settings.map_frame.align;
  if (align != MapFrameOptions::kNone && align != MapFrameOptions::kWalls && !parse_degrees(align))
    throw UserError("map.align = " + align +
                    ": expected walls, none or an angle in degrees, such as 12.5. Correct map.align");
}

LogOptions log_options(const Settings& settings) {
  LogOptions options = settings.log;
  const LaserMount& mount = settings.laser_mount;
  if (mount.x_m || mount.y_m || mount.yaw_rad)
    options.robot_T_laser =
        mrpt::math::TPose2D(mount.x_m.value_or(0), mount.y_m.value_or(0), mount.yaw_rad.value_or(0));
  return options;
}

MapperOptions mapper_options(const Settings& settings) {
  MapperOptions options = settings.mapper;
  options.back_end.seed = settings.run.seed;
  options.back_end.threads = worker_threads(settings.run);
  options.back_end_thread = options.back_end_thread || options.back_end.threads > 1;
  return options;
}

LocalizerOptions localizer_options(const Settings& settings) {
  LocalizerOptions options = settings.localization;
  options.front_end = settings.mapper.front_end;
  options.consensus = settings.mapper.back_end.loop_consensus;
  options.search.genetic = settings.mapper.back_end.genetic;
  options.search.match = settings.mapper.back_end.loop_matcher;
  options.search.smoothing_sigma_m = settings.mapper.front_end.local_map.smoothing_sigma_m;
  options.seed = settings.run.seed;
  return options;
}

int worker_threads(const RunOptions& run) {
  if (run.threads > 0) return run.threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace psi_slam
