// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/exceptions.h>

#include "psi_slam/user_error.h"

namespace psi_slam {

/// A UserError that passes through MRPT's engine. The engine passes only exceptions of its own kind and
/// replaces all others.
class PassedUserError : public UserError, public mrpt::ExceptionWithCallBackBase {
 public:
  explicit PassedUserError(const UserError& error)
      : UserError(error), mrpt::ExceptionWithCallBackBase(error.what(), mrpt::TCallStackBackTrace()) {}
};

/// Returns the result of `work`. Throws its UserError in a form that passes through MRPT's engine.
template <class Work>
auto through_engine(const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    throw PassedUserError(error);
  }
}

}  // namespace psi_slam
