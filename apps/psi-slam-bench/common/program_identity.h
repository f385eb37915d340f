// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace psi_slam {

/// "0.1.0".
std::string program_version();

/// The commit that the program was built from: "bf09480d1c2e", with " and changes" behind it where files that
/// git knows were changed; "unknown" where it was built from no git clone.
std::string program_commit();

/// What made the figures of a page: "psi-slam 0.1.0, commit bf09480d1c2e, AMD EPYC, 2 processors".
std::string measured_by(const std::string& machine);

}  // namespace psi_slam
