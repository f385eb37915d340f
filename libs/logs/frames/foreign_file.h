// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

namespace psi_slam {

/// Returns what a file that is no log probably is, by its first bytes, and what to do with it: two sentences
/// without the last full stop. `head` must hold at least 512 bytes of the file, or all of it.
std::string likely_content(std::string_view head);

}  // namespace psi_slam
