// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sys/file.h>

#include <cerrno>

#include "base/descriptor.h"

namespace psi_slam {

/// Locks an open file or folder until its descriptor is closed. Returns false if another descriptor holds the
/// lock, in any process. On file systems without locks, returns true and locks nothing.
inline bool try_lock_file(const Descriptor& file) {
  return ::flock(file.number(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK;
}

}  // namespace psi_slam
