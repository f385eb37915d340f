// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// Whether the sanitizer of addresses is on. It reserves terabytes of addresses and doubles memory, so limits
/// of memory do not hold. Programs take several times as long.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kHasAddressSanitizer = true;
#else
constexpr bool kHasAddressSanitizer = false;
#endif

/// Whether the sanitizer of threads is on. It keeps a history of the memory in use, which needs several times
/// as much.
#ifdef __SANITIZE_THREAD__
constexpr bool kHasThreadSanitizer = true;
#else
constexpr bool kHasThreadSanitizer = false;
#endif

}  // namespace psi_slam
