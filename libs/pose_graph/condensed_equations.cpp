// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/condensed_equations.h"

#include <algorithm>
#include <numeric>
#include <tuple>
#include <utility>

namespace psi_slam {
namespace {

// A new order of elimination is computed when the number of block products per variable has grown by this
// factor since the last order.
constexpr double kMaxGrowthOfProducts = 1.1;

}  // namespace

std::uint32_t CondensedEquations::add_variable() {
  const auto variable = static_cast<std::uint32_t>(position_.size());
  position_.push_back(variable);
  return variable;
}

std::size_t CondensedEquations::find(std::uint32_t column, std::uint32_t row) const {
  if (column >= hessian_.size()) return kNone;
  const auto first = hessian_.rows.begin() + static_cast<std::ptrdiff_t>(hessian_.column_begin[column]);
  const auto last = hessian_.rows.begin() + static_cast<std::ptrdiff_t>(hessian_.column_begin[column + 1]);
  const auto found = std::lower_bound(first, last, row);
  return found != last && *found == row ? static_cast<std::size_t>(found - hessian_.rows.begin()) : kNone;
}

void CondensedEquations::add_link(std::uint32_t a, std::uint32_t b) {
  if (a == b) return;
  const std::uint32_t row = std::min(position_[a], position_[b]);
  const std::uint32_t column = std::max(position_[a], position_[b]);
  if (find(column, row) == kNone) new_links_.emplace_back(row, column);
}

void CondensedEquations::lay_out(bool reorder) {
  if (position_.empty()) return;
  if (!reorder && new_links_.empty() && hessian_.size() == position_.size()) return;
  std::vector<std::uint32_t> unchanged(position_.size());
  std::iota(unchanged.begin(), unchanged.end(), 0U);
  arrange(unchanged);
  const auto products_per_variable = [&] {
    return static_cast<double>(factor_.num_products()) / static_cast<double>(position_.size());
  };
  if (!reorder && products_per_variable() <= kMaxGrowthOfProducts * products_per_variable_) return;
  find_order();
  products_per_variable_ = products_per_variable();
}

void CondensedEquations::find_order() {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> links;
  for (std::uint32_t column = 0; column < hessian_.size(); ++column)
    for (std::size_t p = hessian_.column_begin[column]; p < hessian_.column_begin[column + 1]; ++p)
      links.emplace_back(hessian_.rows[p], column);
  const std::vector<std::uint32_t> order = fill_reducing_order(hessian_.size(), links);
  std::vector<std::uint32_t> new_position(order.size());
  for (std::uint32_t k = 0; k < order.size(); ++k) new_position[order[k]] = k;
  arrange(new_position);
}

// Moves every position to its new position, and inserts the new links as zero blocks.
void CondensedEquations::arrange(const std::vector<std::uint32_t>& new_position) {
  struct Entry {
    std::uint32_t column, row;
    std::size_t block;  // index of the block before; kNone for a new link
    bool transposed;
    bool operator<(const Entry& other) const {
      return std::tie(column, row, block) < std::tie(other.column, other.row, other.block);
    }
  };
  const std::size_t old_size = hessian_.size();
  std::vector<Entry> entries;
  entries.reserve(hessian_.rows.size() + new_links_.size());
  const auto enter = [&](std::uint32_t row, std::uint32_t column, std::size_t block) {
    const std::uint32_t a = new_position[row];
    const std::uint32_t b = new_position[column];
    entries.push_back({std::max(a, b), std::min(a, b), block, a > b});
  };
  for (std::uint32_t column = 0; column < old_size; ++column)
    for (std::size_t p = hessian_.column_begin[column]; p < hessian_.column_begin[column + 1]; ++p)
      enter(hessian_.rows[p], column, p);
  for (const auto& [row, column] : new_links_) enter(row, column, kNone);
  new_links_.clear();
  std::sort(entries.begin(), entries.end());

  const std::size_t n = new_position.size();
  SymmetricBlockMatrix arranged;
  arranged.column_begin.assign(n + 1, 0);
  arranged.rows.reserve(entries.size());
  arranged.blocks.reserve(entries.size());
  auto entry = entries.begin();
  for (std::uint32_t column = 0; column < n; ++column) {
    for (; entry != entries.end() && entry->column == column; ++entry) {
      if (arranged.rows.size() > arranged.column_begin[column] && arranged.rows.back() == entry->row)
        continue;
      arranged.rows.push_back(entry->row);
      if (entry->block == kNone)
        arranged.blocks.emplace_back(Eigen::Matrix3d::Zero());
      else if (entry->transposed)
        arranged.blocks.emplace_back(hessian_.blocks[entry->block].transpose());
      else
        arranged.blocks.push_back(hessian_.blocks[entry->block]);
    }
    arranged.column_begin[column + 1] = arranged.rows.size();
  }
  arranged.diagonal.assign(n, Eigen::Matrix3d::Zero());
  Eigen::VectorXd gradient = Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(n));
  for (std::uint32_t position = 0; position < old_size; ++position) {
    arranged.diagonal[new_position[position]] = hessian_.diagonal[position];
    gradient.segment<3>(row(new_position[position])) = gradient_.segment<3>(row(position));
  }
  hessian_ = std::move(arranged);
  gradient_ = std::move(gradient);
  for (std::uint32_t& position : position_) position = new_position[position];
  factor_.analyze(hessian_);
}

void CondensedEquations::add(std::uint32_t a, std::uint32_t b, const Eigen::Matrix3d& sum) {
  const std::uint32_t i = position_[a];
  const std::uint32_t j = position_[b];
  if (i < j)
    hessian_.blocks[find(j, i)] += sum;
  else if (i > j)
    hessian_.blocks[find(i, j)] += sum.transpose();
  else
    hessian_.diagonal[i] += sum + sum.transpose();
}

void CondensedEquations::add(std::uint32_t a, const Eigen::Matrix3d& sum, const Eigen::Vector3d& gradient) {
  hessian_.diagonal[position_[a]] += sum;
  gradient_.segment<3>(row(position_[a])) += gradient;
}

bool CondensedEquations::solve() {
  if (!factor_.factorize(hessian_)) return false;
  step_ = -gradient_;
  factor_.solve(step_);
  predicted_decrease_ = -gradient_.dot(step_);
  gradient_.setZero();
  return true;
}

}  // namespace psi_slam
