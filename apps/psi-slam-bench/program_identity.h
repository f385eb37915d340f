// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace psi_slam {

/// "0.1.0".
std::string program_version();

/// The commit that the program was built from: "bf09480d1c2e", with " and changes" behind it where files that
/// git knows were changed; "unknown" where it was built from no git clone.
std::string program_commit();

}  // namespace psi_slam
