// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

namespace psi_slam {

/// Loads a module of psi-slam, which stays loaded, and returns one of its functions. `content` says what the
/// module holds and `remedy` how it is installed, for the error. Throws UserError if it cannot be loaded.
void* function_of_module(const std::string& module, const char* function, const std::string& content,
                         const std::string& remedy);

}  // namespace psi_slam
