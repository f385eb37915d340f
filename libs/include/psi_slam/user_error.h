// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace psi_slam {

/// A mistake that the user can mend: a file that is not there, a key that does not exist, a log without laser.
/// Its text is one sentence that says what, where, and what was expected; programs print it and exit with 2.
class UserError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What went wrong on our side or the machine's (a full disk, a failed write): programs print it and exit with 1.
class SystemFailure : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace psi_slam
