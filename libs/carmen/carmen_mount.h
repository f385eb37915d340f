// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <filesystem>
#include <optional>
#include <string_view>

namespace psi_slam {

/// The pose of the laser on the robot by the two poses that ROBOTLASER lines of that name carry, looked at
/// until the robot has moved 3 m or turned 1 rad. None when the difference of the poses changes meanwhile:
/// then the laser's pose was corrected by some mapper, and the difference is no mount. None also without such
/// lines. Lines that do not parse are passed over.
std::optional<mrpt::math::TPose2D> mount_by_robotlaser(const std::filesystem::path& path,
                                                       std::string_view message);

}  // namespace psi_slam
