// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

extern const char* const kReportStyle;   ///< the report's CSS
extern const char* const kReportScript;  ///< zoom and pan of its map; the page is whole without it

}  // namespace psi_slam
