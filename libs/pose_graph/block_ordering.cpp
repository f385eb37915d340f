// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/block_ordering.h"

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

namespace psi_slam {

std::vector<std::uint32_t> fill_reducing_order(
    std::size_t num_variables, const std::vector<std::pair<std::uint32_t, std::uint32_t>>& links) {
  using Pattern = Eigen::SparseMatrix<float, Eigen::ColMajor, int>;
  const auto size = static_cast<int>(num_variables);
  std::vector<Eigen::Triplet<float, int>> entries;
  entries.reserve(links.size() + num_variables);
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1.0F);
  for (const auto& [row, column] : links)
    entries.emplace_back(static_cast<int>(row), static_cast<int>(column), 1.0F);
  Pattern pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  const auto& indices = permutation.indices();
  return {indices.data(), indices.data() + indices.size()};
}

}  // namespace psi_slam
