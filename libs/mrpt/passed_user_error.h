// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/core/exceptions.h>

#include "psi_slam/user_error.h"

namespace psi_slam {

/// MRPT's engine lets exceptions of its own kind pass and makes a nameless one of all others.
class PassedUserError : public UserError, public mrpt::ExceptionWithCallBackBase {
 public:
  explicit PassedUserError(const UserError& error)
      : UserError(error), mrpt::ExceptionWithCallBackBase(error.what(), mrpt::TCallStackBackTrace()) {}
};

/// The result of `work`, whose UserError gets through MRPT's engine as one.
template <class Work>
auto through_engine(const Work& work) {
  try {
    return work();
  } catch (const UserError& error) {
    throw PassedUserError(error);
  }
}

}  // namespace psi_slam
