// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/config/CConfigFile.h>
#include <mrpt/system/COutputLogger.h>

#include <string>

namespace psi_slam {

/// What all of MRPT's deciders read from their section: from which level on messages are printed.
inline mrpt::system::VerbosityLevel class_verbosity(const std::string& ini, const std::string& section) {
  const mrpt::config::CConfigFile file(ini);
  return static_cast<mrpt::system::VerbosityLevel>(
      file.read_int(section, "class_verbosity", mrpt::system::LVL_INFO, false));
}

}  // namespace psi_slam
