// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Poses and places known from outside: a dock, a position by GPS, a surveyed start, AprilTags, places in a
/// floor plan. They place the map in the frame in which they are stated, here called the frame of the site,
/// and correct its drift.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// A measured pose with independent errors of position and heading.
struct MeasuredPose {
  mrpt::math::TPose2D pose;  ///< metres, radians; the heading has no meaning if its error is empty
  double sigma_m = 0;        ///< standard deviation of x and of y, metres, > 0
  std::optional<double>
      sigma_rad{};  ///< standard deviation of the heading, radians, > 0; empty: unknown heading
  /// Covariance that is added to these variances, along the axes of the frame of the pose: m^2, m rad, rad^2.
  Eigen::Matrix3d further = Eigen::Matrix3d::Zero();
};

/// Pose or position of the robot at a time.
struct KnownPose {
  TimeUs time_us = 0;         ///< time in the log, microseconds
  MeasuredPose site_T_robot;  ///< the robot in the frame of the site
  std::size_t from_scan =
      0;                 ///< first scan of the run that the time belongs to; 0: the first run with the time
  std::string source{};  ///< where this is stated, such as "my.edits:3", for messages
  bool is_matched = false;  ///< found by matching with a prior map, not stated by a person
  /// Number of the scan at this pose, which must be a node. Empty: the scan follows from `time_us`, which is
  /// not unique in logs with equal times or times that run backwards.
  std::optional<std::size_t> scan{};
};

/// Known place of a tag: a mark at a fixed place that a sensor of the robot recognises.
struct TagPlace {
  std::string name;         ///< name of the tag
  MeasuredPose site_T_tag;  ///< the tag in the frame of the site
  std::string source{};     ///< where this is stated, for messages
};

/// A sighting of a tag by the robot. If the place of the tag is unknown, its sightings still constrain the
/// poses of the robot relative to each other.
struct TagSighting {
  std::string name;           ///< name of the tag
  TimeUs time_us = 0;         ///< time in the log, microseconds
  MeasuredPose robot_T_tag;   ///< the tag in the frame of the robot
  std::size_t from_scan = 0;  ///< as KnownPose::from_scan
  std::string source{};       ///< where this is stated, for messages
};

/// All that is known from outside. The order of the elements has no effect.
struct FixedKnowledge {
  std::vector<KnownPose> poses;        ///< poses of the robot
  std::vector<TagPlace> tags;          ///< places of tags, at most one for each name
  std::vector<TagSighting> sightings;  ///< sightings of tags

  /// Returns whether nothing is known.
  bool empty() const { return poses.empty() && tags.empty() && sightings.empty(); }
  /// Returns whether a pose or a tag states the frame of the map.
  bool states_frame() const { return !poses.empty() || !tags.empty(); }
};

}  // namespace psi_slam
