// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <string>

namespace psi_slam {

/// What --start says, "X,Y,YAW_DEG". Throws UserError.
mrpt::math::TPose2D parse_start(const std::string& text);

}  // namespace psi_slam
