// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace psi_slam {

/// "AMD EPYC, 2 processors", as the system tells it.
std::string machine_text();

}  // namespace psi_slam
