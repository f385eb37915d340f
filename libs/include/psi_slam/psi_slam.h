// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Includes all of psi-slam except the adapters to MRPT's interfaces. For an adapter, include
/// `psi_slam/metric_map_builder_psi.h` or `psi_slam/graphslam_deciders.h`.
#pragma once

#include "psi_slam/configuration.h"
#include "psi_slam/fixed_knowledge.h"
#include "psi_slam/frame.h"
#include "psi_slam/frame_source.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/localizer.h"
#include "psi_slam/log_options.h"
#include "psi_slam/loop_record.h"
#include "psi_slam/mapper.h"
#include "psi_slam/mapping_result.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/open_log.h"
#include "psi_slam/pose_graph.h"
#include "psi_slam/time_stamp.h"
#include "psi_slam/user_error.h"
#include "psi_slam/version.h"

/// Graph SLAM for 2D lidar and odometry. Poses are mrpt::math::TPose2D in metres and radians, with x forward,
/// y left and yaw counter-clockwise; `a_T_b` is the pose of b in a.
namespace psi_slam {}
