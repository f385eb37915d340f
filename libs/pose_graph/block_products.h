// SPDX-License-Identifier: BSD-3-Clause
// The inner loop of the sparse Cholesky factorisation. Every kernel adds and multiplies in the same order, so
// all kernels give the same result to the last bit.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>

namespace psi_slam {

/// sums[rows[p]] -= factors[p] * x for 0 <= p < count.
using BlockProducts = void (*)(const Eigen::Matrix3d* factors, const std::uint32_t* rows, std::size_t count,
                               const Eigen::Matrix3d& x, Eigen::Matrix3d* sums);

/// Returns the kernel for every machine.
BlockProducts block_products_baseline();

/// Returns the fastest kernel that this machine can use.
BlockProducts block_products();

}  // namespace psi_slam
