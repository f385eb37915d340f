// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Exceptions of the library.
#pragma once

#include <stdexcept>

namespace psi_slam {

/// An error that the user can correct: a missing file, an unknown key, a log without laser scans. Its text
/// says what is wrong, where, what was expected and what to do next. Programs print it and exit with 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A failure of the system, such as a full disk. Programs print its text and exit with 1.
class SystemFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace psi_slam
