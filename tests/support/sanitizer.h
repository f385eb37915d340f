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

}  // namespace psi_slam
