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
  if (find(column, row) == kNone) new_links_.emplace_back(column, row);
}

void CondensedEquations::lay_out(bool reorder) {
  if (position_.empty()) return;
  if (!reorder && new_links_.empty() && hessian_.size() == position_.size()) return;
  insert_news();
  factor_.extend(hessian_);
  const auto products_per_variable = [&] {
    return static_cast<double>(factor_.num_products()) / static_cast<double>(position_.size());
  };
  if (!reorder && products_per_variable() <= kMaxGrowthOfProducts * products_per_variable_) return;
  find_order();
  products_per_variable_ = products_per_variable();
}

// Appends the new variables, and inserts the new links as zero blocks.
void CondensedEquations::insert_news() {
  const std::size_t n = position_.size();
  hessian_.diagonal.resize(n, Eigen::Matrix3d::Zero());
  hessian_.column_begin.resize(n + 1, hessian_.rows.size());
  gradient_.conservativeResizeLike(Eigen::VectorXd::Zero(3 * static_cast<Eigen::Index>(n)));
  std::sort(new_links_.begin(), new_links_.end());
  new_links_.erase(std::unique(new_links_.begin(), new_links_.end()), new_links_.end());

  SymmetricBlockMatrix extended;
  extended.column_begin.assign(1, 0);
  extended.rows.reserve(hessian_.rows.size() + new_links_.size());
  extended.blocks.reserve(hessian_.rows.size() + new_links_.size());
  auto link = new_links_.begin();
  for (std::uint32_t column = 0; column < n; ++column) {
    const auto insert_before = [&](std::uint32_t row) {
      for (; link != new_links_.end() && *link < std::pair(column, row); ++link) {
        extended.rows.push_back(link->second);
        extended.blocks.emplace_back(Eigen::Matrix3d::Zero());
        factor_.touch(link->second);
      }
    };
    for (std::size_t p = hessian_.column_begin[column]; p < hessian_.column_begin[column + 1]; ++p) {
      insert_before(hessian_.rows[p]);
      extended.rows.push_back(hessian_.rows[p]);
      extended.blocks.push_back(hessian_.blocks[p]);
    }
    insert_before(column);
    extended.column_begin.push_back(extended.rows.size());
  }
  new_links_.clear();
  extended.diagonal = std::move(hessian_.diagonal);
  hessian_ = std::move(extended);
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

// Moves every position to its new position.
void CondensedEquations::arrange(const std::vector<std::uint32_t>& new_position) {
  struct Entry {
    std::uint32_t column, row;
    std::size_t block;  // index of the block before
    bool transposed;
    bool operator<(const Entry& other) const {
      return std::tie(column, row) < std::tie(other.column, other.row);
    }
  };
  const std::size_t n = hessian_.size();
  std::vector<Entry> entries;
  entries.reserve(hessian_.rows.size());
  for (std::uint32_t column = 0; column < n; ++column) {
    for (std::size_t p = hessian_.column_begin[column]; p < hessian_.column_begin[column + 1]; ++p) {
      const std::uint32_t a = new_position[hessian_.rows[p]];
      const std::uint32_t b = new_position[column];
      entries.push_back({std::max(a, b), std::min(a, b), p, a > b});
    }
  }
  std::sort(entries.begin(), entries.end());

  SymmetricBlockMatrix arranged;
  arranged.column_begin.assign(n + 1, 0);
  arranged.rows.reserve(entries.size());
  arranged.blocks.reserve(entries.size());
  for (const Entry& entry : entries) {
    ++arranged.column_begin[entry.column + 1];
    arranged.rows.push_back(entry.row);
    const Eigen::Matrix3d& block = hessian_.blocks[entry.block];
    arranged.blocks.push_back(entry.transposed ? Eigen::Matrix3d(block.transpose()) : block);
  }
  std::partial_sum(arranged.column_begin.begin(), arranged.column_begin.end(), arranged.column_begin.begin());
  arranged.diagonal.resize(n);
  Eigen::VectorXd gradient(gradient_.size());
  for (std::uint32_t position = 0; position < n; ++position) {
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
  factor_.touch(std::min(i, j));
  if (i < j)
    hessian_.blocks[find(j, i)] += sum;
  else if (i > j)
    hessian_.blocks[find(i, j)] += sum.transpose();
  else
    hessian_.diagonal[i] += sum + sum.transpose();
}

void CondensedEquations::add(std::uint32_t a, const Eigen::Matrix3d& sum, const Eigen::Vector3d& gradient) {
  factor_.touch(position_[a]);
  hessian_.diagonal[position_[a]] += sum;
  gradient_.segment<3>(row(position_[a])) += gradient;
}

bool CondensedEquations::solve() {
  if (!factor_.refactorize(hessian_)) return false;
  step_ = -gradient_;
  factor_.solve(step_);
  predicted_decrease_ = -gradient_.dot(step_);
  gradient_.setZero();
  return true;
}

}  // namespace psi_slam
