// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>

namespace psi_slam {

/// Limits what the calling thread allocates during the lifetime of this object. An allocation beyond the
/// limit throws std::bad_alloc. Freed memory still counts. A nested limit also counts for the outer ones.
/// Counts operator new and mrpt::aligned_malloc(), not malloc(). It is for calls of other libraries that
/// allocate whatever size a file states. Works in programs that link psi_slam_limited_new, as those of
/// psi-slam do; in others it does nothing.
class AllocationLimit {
 public:
  explicit AllocationLimit(std::size_t max_bytes)
      : withheld_bytes_(left_bytes_ - std::min(max_bytes, left_bytes_)) {
    left_bytes_ -= withheld_bytes_;
  }
  ~AllocationLimit() { left_bytes_ += withheld_bytes_; }
  AllocationLimit(const AllocationLimit&) = delete;
  AllocationLimit& operator=(const AllocationLimit&) = delete;

  /// Counts an allocation of the calling thread. Returns false if it would exceed a limit, and then does not
  /// count it.
  static bool take(std::size_t bytes) {
    if (bytes > left_bytes_) return false;
    left_bytes_ -= bytes;
    return true;
  }

 private:
  // Without a limit, so many bytes that no thread allocates them.
  static inline thread_local std::size_t left_bytes_ = std::numeric_limits<std::size_t>::max();
  std::size_t withheld_bytes_;
};

}  // namespace psi_slam
