// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/metric_map_builder_psi.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mrpt/img/CImage.h>
#include <mrpt/io/CFileGZInputStream.h>
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>
#include <mrpt/poses/CPosePDFGaussian.h>
#include <mrpt/serialization/CArchive.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <set>
#include <stdexcept>
#include <thread>
#include <type_traits>

#include "../mapping/local_maps/simulated_drive.h"
#include "logs/observations/mrpt_objects.h"
#include "psi_slam/mapper.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"
#include "rawlog_files.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using mrpt::math::TPose2D;
using mrpt::obs::CActionCollection;
using mrpt::obs::CObservation;
using mrpt::obs::CRawlog;
using mrpt::obs::CSensoryFrame;
using mrpt::poses::CPose2D;
using testing::HasSubstr;

constexpr const char* kRawlog =
    "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";

// Maps a rawlog of either form, actions or single observations, and writes the map, as a user's program does.
void map_rawlog(const std::string& rawlog, CMetricMapBuilderPsi& builder, const std::string& folder) {
  mrpt::io::CFileGZInputStream file(rawlog);
  auto archive = mrpt::serialization::archiveFrom(file);
  std::size_t entry = 0;
  CActionCollection::Ptr actions;
  CSensoryFrame::Ptr observations;
  CObservation::Ptr observation;
  while (CRawlog::getActionObservationPairOrObservation(archive, actions, observations, observation, entry))
    observation ? builder.processObservation(observation)
                : builder.processActionObservation(*actions, *observations);
  builder.finish();
  builder.saveCurrentMapToFile(folder + "/map.simplemap.gz");
  builder.saveCurrentEstimationToImage(folder + "/map.png");
}

MappingResult map_by_the_reader(const std::string& rawlog, std::size_t first_scan = 0) {
  Mapper mapper;
  const auto source = open_log(rawlog);
  while (auto frame = source->next())
    if (frame->index >= first_scan) mapper.add(*std::move(frame));
  return mapper.finish();
}

mrpt::poses::CPosePDFGaussian estimate_of(const CMetricMapBuilderPsi& builder) {
  const auto pose = builder.getCurrentPoseEstimation();
  EXPECT_NE(dynamic_cast<const mrpt::poses::CPose3DPDFGaussian*>(pose.get()), nullptr);
  return mrpt::poses::CPosePDFGaussian(*pose);
}

void expect_pose(const TPose2D& pose, const TPose2D& expected, double tolerance = 1e-9) {
  EXPECT_NEAR(pose.x, expected.x, tolerance);
  EXPECT_NEAR(pose.y, expected.y, tolerance);
  EXPECT_NEAR(std::remainder(pose.phi - expected.phi, 2 * M_PI), 0, tolerance);
}

std::vector<TPose2D> node_poses(const CMetricMapBuilderPsi& builder) {
  mrpt::maps::CSimpleMap map;
  builder.getCurrentlyBuiltMap(map);
  std::vector<TPose2D> poses;
  for (const auto& keyframe : map) {
    poses.push_back(CPose2D(keyframe.pose->getMeanVal()).asTPose());
    EXPECT_GE(keyframe.sf->size(), 1U);
  }
  return poses;
}

template <class Map>
const mrpt::maps::CMultiMetricMap& as_reference(const Map& map) {
  if constexpr (std::is_pointer_v<Map>)
    return *map;
  else
    return map;
}

// Returns the metric map of a builder. MRPT returns it as a pointer before version 2.9.2.
const mrpt::maps::CMultiMetricMap& metric_map_of(const CMetricMapBuilderPsi& builder) {
  return as_reference(builder.getCurrentlyBuiltMetricMap());
}

// Returns the first scans of a simulated run with wrong odometry.
SimulatedDrive observed_drive(std::size_t scans = 150) {
  OdometryErrors errors;
  errors.length_share = 0.05;
  errors.turn_share = 0.1;
  SimulatedDrive drive = drive_along(office_floor(), round_the_office(), errors, 1);
  drive.frames.resize(scans);
  return drive;
}

RawlogObjects as_observations(const SimulatedDrive& drive) {
  RawlogObjects objects;
  for (const Frame& frame : drive.frames) {
    objects.push_back(odometry(frame.time_us - 30'000, CPose2D(frame.odom_T_robot)));
    objects.push_back(range_observation(frame));
  }
  return objects;
}

void process(CMetricMapBuilderPsi& builder, const RawlogObjects& objects) {
  for (const auto& object : objects)
    builder.processObservation(std::dynamic_pointer_cast<CObservation>(object));
}

void process_as_actions(CMetricMapBuilderPsi& builder, const SimulatedDrive& drive) {
  TPose2D last;
  for (const Frame& frame : drive.frames) {
    const auto actions = movement(CPose2D(frame.odom_T_robot - last));
    const auto observations = sensory_frame({range_observation(frame)});
    builder.processActionObservation(*actions, *observations);
    last = frame.odom_T_robot;
  }
}

TEST(MetricMapBuilderPsi, maps_a_rawlog_in_ten_lines) {
  if (!fs::exists(kRawlog)) GTEST_SKIP() << "needs the data sets of the package mrpt-common";
  const TemporaryFolder folder;
  CMetricMapBuilderPsi builder;
  map_rawlog(kRawlog, builder, folder.path().string());

  // This log begins with a sensory frame. MRPT reads pairs of an action and the next sensory frame, so it
  // skips the first scan.
  const MappingResult expected = map_by_the_reader(kRawlog, 1);
  EXPECT_TRUE(std::any_of(expected.loops.begin(), expected.loops.end(),
                          [](const LoopRecord& loop) { return loop.state == LoopState::kAccepted; }));
  ASSERT_EQ(builder.getCurrentlyBuiltMapSize(), expected.node_frames.size());
  const std::vector<TPose2D> poses = node_poses(builder);
  for (std::size_t node = 0; node < poses.size(); ++node)
    expect_pose(poses[node], expected.frames[expected.node_frames[node]].map_T_robot);
  expect_pose(estimate_of(builder).mean.asTPose(), expected.frames.back().map_T_robot);

  mrpt::maps::CSimpleMap loaded;
  ASSERT_TRUE(loaded.loadFromFile((folder.path() / "map.simplemap.gz").string()));
  EXPECT_EQ(loaded.size(), expected.node_frames.size());
  mrpt::img::CImage picture;
  ASSERT_TRUE(picture.loadFromFile((folder.path() / "map.png").string()));
  EXPECT_GT(picture.getWidth(), 300U);
  EXPECT_GT(picture.getHeight(), 300U);
}

TEST(MetricMapBuilderPsi, observations_one_by_one_give_what_reading_their_rawlog_gives) {
  const TemporaryFolder folder;
  const std::string rawlog = (folder.path() / "drive.rawlog").string();
  write_rawlog(rawlog, as_observations(observed_drive()));
  const MappingResult expected = map_by_the_reader(rawlog);
  CMetricMapBuilderPsi builder;
  map_rawlog(rawlog, builder, folder.path().string());
  ASSERT_EQ(builder.getCurrentlyBuiltMapSize(), expected.node_frames.size());
  EXPECT_GT(builder.getCurrentlyBuiltMapSize(), 20U);
  expect_pose(estimate_of(builder).mean.asTPose(), expected.frames.back().map_T_robot);
}

TEST(MetricMapBuilderPsi, follows_the_robot_while_it_drives) {
  const SimulatedDrive drive = observed_drive();
  CMetricMapBuilderPsi builder;
  TPose2D last;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    const Frame& frame = drive.frames[i];
    const auto actions = movement(CPose2D(frame.odom_T_robot - last));
    const auto observations = sensory_frame({range_observation(frame)});
    builder.processActionObservation(*actions, *observations);
    last = frame.odom_T_robot;
    const mrpt::poses::CPosePDFGaussian estimate = estimate_of(builder);
    expect_pose(estimate.mean.asTPose(), drive.map_T_robot[i], 0.1);
    const Eigen::Matrix3d covariance = estimate.cov.asEigen();
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(covariance).eigenvalues()[0], 0);
    EXPECT_LT(covariance.trace(), 0.1);
  }
  EXPECT_EQ(node_poses(builder).size(), builder.getCurrentlyBuiltMapSize());
}

TEST(MetricMapBuilderPsi, asking_often_changes_the_covariance_little_while_driving_and_not_at_the_end) {
  const SimulatedDrive drive = observed_drive();
  CMetricMapBuilderPsi asked_always;
  TPose2D last;
  for (std::size_t i = 0; i < drive.frames.size(); ++i) {
    CActionCollection::Ptr actions = movement(CPose2D(drive.frames[i].odom_T_robot - last));
    CSensoryFrame::Ptr observations = sensory_frame({range_observation(drive.frames[i])});
    asked_always.processActionObservation(*actions, *observations);
    last = drive.frames[i].odom_T_robot;
    const Eigen::Matrix3d covariance = estimate_of(asked_always).cov.asEigen();
    if (i % 30 != 29) continue;
    SimulatedDrive so_far = drive;
    so_far.frames.resize(i + 1);
    CMetricMapBuilderPsi asked_once;
    process_as_actions(asked_once, so_far);
    EXPECT_TRUE(covariance.isApprox(estimate_of(asked_once).cov.asEigen(), 0.1)) << "after scan " << i;
  }
  CMetricMapBuilderPsi asked_once;
  process_as_actions(asked_once, drive);
  asked_once.finish();
  asked_always.finish();
  EXPECT_TRUE(estimate_of(asked_always).cov.asEigen().isApprox(estimate_of(asked_once).cov.asEigen(), 1e-6));
}

TEST(MetricMapBuilderPsi, both_forms_give_the_same_map) {
  const SimulatedDrive drive = observed_drive();
  CMetricMapBuilderPsi by_actions;
  process_as_actions(by_actions, drive);
  by_actions.finish();
  RawlogObjects objects;  // with odometry at the exact time of each scan
  for (const Frame& frame : drive.frames) {
    objects.push_back(odometry(frame.time_us, CPose2D(frame.odom_T_robot)));
    objects.push_back(range_observation(frame));
  }
  CMetricMapBuilderPsi by_observations;
  process(by_observations, objects);
  by_observations.finish();
  expect_pose(estimate_of(by_actions).mean.asTPose(), estimate_of(by_observations).mean.asTPose(), 1e-3);
  EXPECT_EQ(by_actions.getCurrentlyBuiltMapSize(), by_observations.getCurrentlyBuiltMapSize());
}

TEST(MetricMapBuilderPsi, before_the_first_scan_the_map_is_empty) {
  CMetricMapBuilderPsi builder;
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U);
  EXPECT_TRUE(node_poses(builder).empty());
  expect_pose(estimate_of(builder).mean.asTPose(), {0, 0, 0});
  EXPECT_EQ(estimate_of(builder).cov.asEigen().norm(), 0);
  ASSERT_NE(builder.grid(), nullptr);
  builder.finish();
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U);
}

TEST(MetricMapBuilderPsi, starts_at_the_given_pose) {
  const SimulatedDrive drive = observed_drive(60);
  CMetricMapBuilderPsi at_origin;
  process_as_actions(at_origin, drive);
  at_origin.finish();

  CMetricMapBuilderPsi elsewhere;
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 0.04);
  const TPose2D start(10, -5, 2);
  const mrpt::poses::CPosePDFGaussian x0(CPose2D(start), covariance);
  elsewhere.initialize(mrpt::maps::CSimpleMap(), &x0);
  expect_pose(estimate_of(elsewhere).mean.asTPose(), start);
  process_as_actions(elsewhere, drive);
  elsewhere.finish();

  const std::vector<TPose2D> expected = node_poses(at_origin);
  const std::vector<TPose2D> poses = node_poses(elsewhere);
  ASSERT_EQ(poses.size(), expected.size());
  for (std::size_t i = 0; i < poses.size(); ++i) expect_pose(poses[i], start + expected[i]);
  const mrpt::poses::CPosePDFGaussian estimate = estimate_of(elsewhere);
  expect_pose(estimate.mean.asTPose(), start + estimate_of(at_origin).mean.asTPose());
  EXPECT_GT(estimate.cov(0, 0), 0.04) << "the robot's uncertainty includes that of the start";

  // The grid must be moved by the start pose too, so the robot's cell is free.
  const TPose2D stood = poses.back();
  EXPECT_GT(elsewhere.grid()->getPos(static_cast<float>(stood.x), static_cast<float>(stood.y)), 0.6F);
}

TEST(MetricMapBuilderPsi, initialize_begins_another_map) {
  const SimulatedDrive drive = observed_drive(60);
  CMetricMapBuilderPsi builder;
  process_as_actions(builder, drive);
  builder.finish();
  const TPose2D first = estimate_of(builder).mean.asTPose();
  const std::size_t nodes = builder.getCurrentlyBuiltMapSize();

  builder.clear();
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U);
  process_as_actions(builder, drive);
  builder.finish();
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), nodes);
  expect_pose(estimate_of(builder).mean.asTPose(), first);

  builder.initialize();
  expect_pose(estimate_of(builder).mean.asTPose(), first);  // without a given start, the estimate stays
}

// Returns the map of a run that starts at `start`, from its first scans.
mrpt::maps::CSimpleMap first_map(const TPose2D& start, std::size_t scans) {
  CMetricMapBuilderPsi builder;
  mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
  covariance.setDiagonal(3, 1e-6);
  const mrpt::poses::CPosePDFGaussian x0(CPose2D(start), covariance);
  builder.initialize({}, &x0);
  process_as_actions(builder, observed_drive(scans));
  builder.finish();
  mrpt::maps::CSimpleMap map;
  builder.getCurrentlyBuiltMap(map);
  return map;
}

// Two thirds of the way round the office are the initial map; the run goes all the way round.
TEST(MetricMapBuilderPsi, an_initial_map_is_extended_in_its_frame) {
  const TPose2D start(10, -5, 2);
  const mrpt::maps::CSimpleMap initial = first_map(start, 450);
  const SimulatedDrive drive = observed_drive(700);
  for (const bool is_start_known : {true, false}) {
    CMetricMapBuilderPsi builder;
    mrpt::math::CMatrixDouble33 covariance = mrpt::math::CMatrixDouble33::Zero();
    covariance.setDiagonal(3, 0.01);
    const mrpt::poses::CPosePDFGaussian x0(CPose2D(start + TPose2D(0.2, -0.1, 0.05)), covariance);
    builder.initialize(initial, is_start_known ? &x0 : nullptr);
    process_as_actions(builder, drive);
    expect_pose(estimate_of(builder).mean.asTPose(), start + drive.map_T_robot[drive.frames.size() - 1], 0.2);
    builder.finish();
    expect_pose(estimate_of(builder).mean.asTPose(), start + drive.map_T_robot[drive.frames.size() - 1],
                0.08);
    EXPECT_GT(estimate_of(builder).cov(0, 0), 0);
    const std::vector<TPose2D> poses = node_poses(builder);
    ASSERT_GT(poses.size(), 2 * initial.size());
    EXPECT_EQ(poses.size(), builder.getCurrentlyBuiltMapSize());
    expect_pose(poses[initial.size()], start, 0.06);

    const auto grid = builder.grid();
    const auto far = start + TPose2D(drive.map_T_robot[650].x, drive.map_T_robot[650].y, 0);
    EXPECT_GT(grid->getPos(static_cast<float>(far.x), static_cast<float>(far.y)), 0.6F);
  }
}

TEST(MetricMapBuilderPsi, a_run_elsewhere_does_not_extend_the_initial_map) {
  const mrpt::maps::CSimpleMap initial = first_map({0, 0, 0}, 100);
  CMetricMapBuilderPsi builder;
  builder.initialize(initial);
  SimulatedDrive room = drive_along(furnished_room(), path_along({{1, 3}, {6, 3}, {6, 1}, {3, 2}}), {}, 3);
  process_as_actions(builder, room);
  builder.finish();
  expect_pose(estimate_of(builder).mean.asTPose(), room.map_T_robot.back(), 0.1);
  EXPECT_EQ(node_poses(builder).size(), builder.getCurrentlyBuiltMapSize());
  expect_pose(node_poses(builder).front(), {0, 0, 0}, 1e-6);
}

TEST(MetricMapBuilderPsi, an_initial_map_without_scans_is_refused) {
  CMetricMapBuilderPsi builder;
  mrpt::maps::CSimpleMap map;
  map.insert(mrpt::poses::CPose3DPDFGaussian::Create(), CSensoryFrame::Create());
  try {
    builder.initialize(map);
    FAIL() << "no exception";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("has 1 frames, but no return of a 2D range scan"));
  }
}

TEST(MetricMapBuilderPsi, its_metric_map_is_one_grid_drawn_when_asked_for) {
  const SimulatedDrive drive = observed_drive(100);
  CMetricMapBuilderPsi builder;
  const mrpt::maps::CMultiMetricMap* metric_map = &metric_map_of(builder);
  const auto before = builder.grid();
  process_as_actions(builder, drive);
  ASSERT_EQ(metric_map->maps.size(), 1U);
  EXPECT_EQ(metric_map->mapByClass<mrpt::maps::COccupancyGridMap2D>(), before)
      << "the map stays as it was drawn, until the next call";

  EXPECT_EQ(&metric_map_of(builder), metric_map) << "the builder always returns the same object";
  const auto grid = metric_map->mapByClass<mrpt::maps::COccupancyGridMap2D>();
  EXPECT_NE(grid, before);
  EXPECT_GT(grid->getSizeX(), before->getSizeX());
  EXPECT_EQ(builder.grid(), grid) << "without a new scan, no grid is drawn";
  builder.finish();
  EXPECT_NE(builder.grid(), grid);

  // The grid shows the south wall of the corridor, 1.6 m to the right of the start, and free space on the
  // robot's path.
  const auto last = builder.grid();
  EXPECT_LT(last->getPos(1.5F, -1.62F), 0.4F);
  // Skips the first poses, because no scan observed the space around the start.
  for (std::size_t i = 10; i < drive.frames.size(); i += 10) {
    const TPose2D& pose = drive.map_T_robot[i];
    EXPECT_GT(last->getPos(static_cast<float>(pose.x), static_cast<float>(pose.y)), 0.6F);
  }
}

using mrpt::maps::COccupancyGridMap2D;

COccupancyGridMap2D::Ptr metric_grid(const CMetricMapBuilderPsi& builder) {
  return metric_map_of(builder).mapByClass<COccupancyGridMap2D>();
}

// Maps scan by scan. Calls `ask` after each scan.
void process_and_ask(CMetricMapBuilderPsi& builder, const SimulatedDrive& drive,
                     const std::function<void()>& ask) {
  TPose2D last;
  for (const Frame& frame : drive.frames) {
    const auto actions = movement(CPose2D(frame.odom_T_robot - last));
    const auto observations = sensory_frame({range_observation(frame)});
    builder.processActionObservation(*actions, *observations);
    last = frame.odom_T_robot;
    ask();
  }
}

TEST(MetricMapBuilderPsi, the_map_is_the_same_however_often_it_was_asked_for) {
  const SimulatedDrive drive = observed_drive(60);
  CMetricMapBuilderPsi asked_always;
  std::set<const void*> objects;
  process_and_ask(asked_always, drive, [&] { objects.insert(metric_grid(asked_always).get()); });
  EXPECT_LT(objects.size(), 40U) << "a map of the same extent is changed, not copied";
  CMetricMapBuilderPsi asked_once;
  process_as_actions(asked_once, drive);
  EXPECT_EQ(metric_grid(asked_always)->getRawMap(), metric_grid(asked_once)->getRawMap());
  EXPECT_EQ(asked_once.grid()->getRawMap(), metric_grid(asked_once)->getRawMap());
}

TEST(MetricMapBuilderPsi, a_grid_never_changes) {
  CMetricMapBuilderPsi builder;
  COccupancyGridMap2D::ConstPtr early;
  std::vector<COccupancyGridMap2D::cellType> cells;
  process_and_ask(builder, observed_drive(60), [&] {
    if (!early) cells = (early = builder.grid())->getRawMap();
    builder.getCurrentlyBuiltMetricMap();
  });
  EXPECT_EQ(early->getRawMap(), cells);
}

TEST(MetricMapBuilderPsi, the_map_follows_closed_loops) {
  // A laser of short range and wrong odometry: the loops of the second round correct the map. The path is
  // uncertain by metres, so matches wait until several agree.
  OdometryErrors errors;
  errors.length_factor = 1.1;
  errors.turn_share = 0.1;
  errors.drift_rad_per_m = 0.01;
  const auto path =
      path_along({{1.6, 1.6}, {18.3, 1.6}, {18.3, 12.4}, {1.6, 12.4}, {1.6, 1.6}, {18.3, 1.6}, {18.3, 8}});
  const SimulatedDrive drive = drive_along(office_floor(), path, errors, 1);
  CMetricMapBuilderPsi::Options options;
  options.log.max_range_m = 3;
  CMetricMapBuilderPsi asked_always(options);
  std::vector<TPose2D> first_poses;
  process_and_ask(asked_always, drive, [&] {
    asked_always.getCurrentlyBuiltMetricMap();
    if (asked_always.getCurrentlyBuiltMapSize() == first_poses.size()) return;
    first_poses.push_back(node_poses(asked_always).back());
  });
  const std::vector<TPose2D> poses = node_poses(asked_always);
  double correction_m = 0;
  for (std::size_t i = 0; i < poses.size(); ++i)
    correction_m = std::max(correction_m, (poses[i] - first_poses[i]).norm());
  ASSERT_GT(correction_m, 0.1) << "otherwise the test would show nothing";
  for (int i = 0; i < 200; ++i) asked_always.getCurrentlyBuiltMetricMap();
  CMetricMapBuilderPsi asked_once(options);
  process_as_actions(asked_once, drive);
  const auto followed = metric_grid(asked_always);
  const auto expected = metric_grid(asked_once);
  // Scans that moved by less than half a cell stay where they were.
  std::size_t walls = 0;
  std::size_t missed = 0;
  const auto is_wall = [](const COccupancyGridMap2D& grid, double x, double y) {
    return grid.getPos(static_cast<float>(x), static_cast<float>(y)) < 0.35F;
  };
  for (unsigned y = 0; y < expected->getSizeY(); ++y)
    for (unsigned x = 0; x < expected->getSizeX(); ++x) {
      const auto cell_x = static_cast<double>(expected->idx2x(x));
      const auto cell_y = static_cast<double>(expected->idx2y(y));
      if (!is_wall(*expected, cell_x, cell_y)) continue;
      ++walls;
      bool any = false;
      for (const double dx : {-0.05, 0.0, 0.05})
        for (const double dy : {-0.05, 0.0, 0.05}) any = any || is_wall(*followed, cell_x + dx, cell_y + dy);
      missed += any ? 0 : 1;
    }
  EXPECT_GT(walls, 1000U);
  EXPECT_LT(missed, walls / 100);
}

TEST(MetricMapBuilderPsi, nodes_of_two_lasers_keep_the_observations_of_both) {
  const SimulatedDrive drive = observed_drive(30);
  CMetricMapBuilderPsi::Options options;
  options.log.laser = "all";
  CMetricMapBuilderPsi builder(options);
  for (const Frame& frame : drive.frames) {
    builder.processObservation(odometry(frame.time_us, CPose2D(frame.odom_T_robot)));
    builder.processObservation(range_observation(frame));
    auto rear = range_scan(frame.time_us + 50'000, "REAR");
    rear->sensorPose = mrpt::poses::CPose3D(-0.3, 0, 0, M_PI, 0, 0);
    builder.processObservation(rear);
  }
  builder.finish();
  mrpt::maps::CSimpleMap map;
  builder.getCurrentlyBuiltMap(map);
  ASSERT_GT(map.size(), 3U);
  for (const auto& keyframe : map) EXPECT_EQ(keyframe.sf->size(), 2U);
}

TEST(MetricMapBuilderPsi, other_observations_are_kept_beside_their_scan) {
  const SimulatedDrive drive = observed_drive(30);
  CMetricMapBuilderPsi with_another;
  CMetricMapBuilderPsi alone;
  process_as_actions(alone, drive);
  TPose2D last;
  for (const Frame& frame : drive.frames) {
    auto other = range_scan(frame.time_us, "REAR");
    const auto actions = movement(CPose2D(frame.odom_T_robot - last));
    const auto observations = sensory_frame({range_observation(frame), other});
    with_another.processActionObservation(*actions, *observations);
    observations->clear();  // the builder must keep its own list of observations
    last = frame.odom_T_robot;
  }
  EXPECT_EQ(node_poses(with_another), node_poses(alone));
  mrpt::maps::CSimpleMap map;
  with_another.getCurrentlyBuiltMap(map);
  EXPECT_EQ(map.begin()->sf->size(), 2U);
}

TEST(MetricMapBuilderPsi, uses_laser_and_mount_of_the_options) {
  CMetricMapBuilderPsi::Options options;
  options.log.laser = "REAR";
  CMetricMapBuilderPsi builder(options);
  process_as_actions(builder, observed_drive(10));
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U) << "the scans are of another laser";
  options.log.min_range_m = -1;
  EXPECT_THROW(CMetricMapBuilderPsi{options}, UserError);
}

TEST(MetricMapBuilderPsi, the_kind_of_odometry_that_comes_first_decides) {
  const SimulatedDrive drive = observed_drive(60);
  CMetricMapBuilderPsi actions_alone;
  process_as_actions(actions_alone, drive);
  CMetricMapBuilderPsi both;
  TPose2D last;
  for (const Frame& frame : drive.frames) {
    const auto actions = movement(CPose2D(frame.odom_T_robot - last));
    const auto observations =
        sensory_frame({odometry(frame.time_us, CPose2D(100, 100, 1)), range_observation(frame)});
    both.processActionObservation(*actions, *observations);
    last = frame.odom_T_robot;
  }
  EXPECT_EQ(node_poses(both), node_poses(actions_alone));
}

TEST(MetricMapBuilderPsi, scans_before_the_first_action_are_at_the_start) {
  const SimulatedDrive drive = observed_drive(40);
  CMetricMapBuilderPsi builder;
  builder.processObservation(range_observation(drive.frames[0]));
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U) << "the scan waits for its odometry";
  process_as_actions(builder, drive);
  EXPECT_GT(builder.getCurrentlyBuiltMapSize(), 3U);
  expect_pose(node_poses(builder).front(), {0, 0, 0});
}

TEST(MetricMapBuilderPsi, maps_scans_without_odometry) {
  const auto path = path_along({{2, 1.5}, {6, 1.6}}, 0.03, 0.03);
  const SimulatedDrive drive = drive_along(office_floor(), path, {}, 5);
  CMetricMapBuilderPsi builder;
  for (const Frame& frame : drive.frames) builder.processObservation(range_observation(frame));
  EXPECT_EQ(builder.getCurrentlyBuiltMapSize(), 0U) << "the scans wait for odometry";
  builder.finish();
  EXPECT_GT(builder.getCurrentlyBuiltMapSize(), 3U);
  const TPose2D found = node_poses(builder).back();
  const TPose2D truth = drive.map_T_robot.back();
  EXPECT_LT(std::hypot(found.x - truth.x, found.y - truth.y), 0.3);
}

TEST(MetricMapBuilderPsi, unusable_input_is_an_error) {
  CMetricMapBuilderPsi builder;
  EXPECT_THROW(builder.processObservation(nullptr), std::invalid_argument);
  const auto frame = observed_drive(1).frames[0];
  auto scan = range_observation(frame);
  scan->timestamp = INVALID_TIMESTAMP;
  EXPECT_THROW(builder.processObservation(scan), UserError);
  builder.enableMapUpdating(false);
  EXPECT_THROW(builder.processObservation(range_observation(frame)), UserError);
  CActionCollection no_actions;
  CSensoryFrame no_observations;
  EXPECT_THROW(builder.processActionObservation(no_actions, no_observations), UserError);
  builder.enableMapUpdating(true);
  builder.finish();
  builder.finish();
  EXPECT_THROW(builder.processObservation(range_observation(frame)), std::logic_error);
}

TEST(MetricMapBuilderPsi, pictures_have_the_format_of_their_extension) {
  const TemporaryFolder folder;
  CMetricMapBuilderPsi builder;
  process_as_actions(builder, observed_drive(60));
  for (const char* name : {"map.png", "map.pgm", "map.bmp"}) {
    const std::string path = (folder.path() / name).string();
    builder.saveCurrentEstimationToImage(path, false);
    mrpt::img::CImage picture;
    ASSERT_TRUE(picture.loadFromFile(path)) << name;
    EXPECT_GT(picture.getWidth(), 100U) << name;
  }
  for (const char* name : {"missing/map.png", "missing/map.pgm"})
    EXPECT_THROW(builder.saveCurrentEstimationToImage((folder.path() / name).string()), SystemFailure)
        << name;
}

TEST(MetricMapBuilderPsi, answers_another_thread_while_mapping) {
  const SimulatedDrive drive = observed_drive();
  CMetricMapBuilderPsi alone;
  process_as_actions(alone, drive);
  alone.finish();

  CMetricMapBuilderPsi watched;
  std::atomic<bool> done{false};
  std::thread viewer([&] {
    unsigned int nodes = 0;
    while (!done) {
      const unsigned int now = watched.getCurrentlyBuiltMapSize();
      EXPECT_GE(now, nodes);
      nodes = now;
      EXPECT_TRUE(std::isfinite(estimate_of(watched).mean.x()));
      EXPECT_GT(watched.grid()->getSizeX(), 0U);
      node_poses(watched);
    }
  });
  process_as_actions(watched, drive);
  watched.finish();
  done = true;
  viewer.join();
  EXPECT_EQ(node_poses(watched), node_poses(alone));
}

}  // namespace
}  // namespace psi_slam
