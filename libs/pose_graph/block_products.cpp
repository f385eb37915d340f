// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_products.h"

#include <cstring>

#include "base/instruction_set.h"

namespace psi_slam {
namespace {

// The loops are written out so that the compiler keeps x in registers over a column.
void subtract_products(const Eigen::Matrix3d* factors, const std::uint32_t* rows, std::size_t count,
                       const Eigen::Matrix3d& block, Eigen::Matrix3d* sums) {
  const double* const x = block.data();
  for (std::size_t p = 0; p < count; ++p) {
    const double* const l = factors[p].data();
    double* const y = sums[rows[p]].data();
    for (int c = 0; c < 3; ++c) {
      const double x0 = x[3 * c];
      const double x1 = x[3 * c + 1];
      const double x2 = x[3 * c + 2];
      for (int r = 0; r < 3; ++r) y[3 * c + r] -= l[r] * x0 + l[3 + r] * x1 + l[6 + r] * x2;
    }
  }
}

#ifdef __x86_64__

using Four = double __attribute__((vector_size(32)));

// The nine numbers of a block are those of two vectors, which begin at 0 and 4, and the last number.
__attribute__((target("avx2"))) void subtract_products_avx2(const Eigen::Matrix3d* factors,
                                                            const std::uint32_t* rows, std::size_t count,
                                                            const Eigen::Matrix3d& block,
                                                            Eigen::Matrix3d* sums) {
  const double* const x = block.data();
  const Four low0{x[0], x[0], x[0], x[3]}, low1{x[1], x[1], x[1], x[4]}, low2{x[2], x[2], x[2], x[5]};
  const Four high0{x[3], x[3], x[6], x[6]}, high1{x[4], x[4], x[7], x[7]}, high2{x[5], x[5], x[8], x[8]};
  const double last0 = x[6], last1 = x[7], last2 = x[8];
  for (std::size_t p = 0; p < count; ++p) {
    const double* const l = factors[p].data();
    double* const y = sums[rows[p]].data();
    Four l0, l1, l2, low, high;  // l2 begins one number before its column, and so ends with the block
    std::memcpy(&l0, l, sizeof l0);
    std::memcpy(&l1, l + 3, sizeof l1);
    std::memcpy(&l2, l + 5, sizeof l2);
    std::memcpy(&low, y, sizeof low);
    std::memcpy(&high, y + 4, sizeof high);
    low -= __builtin_shufflevector(l0, l0, 0, 1, 2, 0) * low0 +
           __builtin_shufflevector(l1, l1, 0, 1, 2, 0) * low1 +
           __builtin_shufflevector(l2, l2, 1, 2, 3, 1) * low2;
    high -= __builtin_shufflevector(l0, l0, 1, 2, 0, 1) * high0 +
            __builtin_shufflevector(l1, l1, 1, 2, 0, 1) * high1 +
            __builtin_shufflevector(l2, l2, 2, 3, 1, 2) * high2;
    const double last = y[8] - (l[2] * last0 + l[5] * last1 + l[8] * last2);
    std::memcpy(y, &low, sizeof low);
    std::memcpy(y + 4, &high, sizeof high);
    y[8] = last;
  }
}

#endif

}  // namespace

BlockProducts block_products_baseline() {
  return subtract_products;
}

BlockProducts block_products() {
#ifdef __x86_64__
  static const bool has_avx2 = can_use(InstructionSet::kAvx2);
  if (has_avx2) return subtract_products_avx2;
#endif
  return subtract_products;
}

}  // namespace psi_slam
