// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// A difference is significant, and is reported or used, if it exceeds so many of its standard deviations.
inline constexpr double kSignificantDeviations = 4;

}  // namespace psi_slam
