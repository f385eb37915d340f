// SPDX-License-Identifier: BSD-3-Clause
// The fields of a row of comma-separated values (RFC 4180).
#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>

namespace psi_slam {

/// A text as one field: quoted where it must be.
std::string csv_field(const std::string& text);

/// "x,y,theta" with six decimals.
std::string csv_pose(const mrpt::math::TPose2D& pose);

}  // namespace psi_slam
