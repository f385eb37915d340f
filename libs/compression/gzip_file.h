// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>

namespace psi_slam {

/// The bytes as a gzip file whose header holds neither name nor time. Throws SystemFailure when memory runs
/// out.
std::string gzipped(const void* bytes, std::size_t count);

}  // namespace psi_slam
