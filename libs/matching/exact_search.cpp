// SPDX-License-Identifier: BSD-3-Clause
#include "matching/exact_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "matching/bound_level.h"
#include "matching/sum_kernel.h"

namespace psi_slam {
namespace {

// A cell of the tables of bounds takes as long to make as the exhaustive search takes to add this many
// scores.
constexpr double kScoresPerCell = 40;
// In windows with more poses than this, another level of large blocks saves more than its tables cost.
constexpr double kHugePoses = 150e6;

// Returns whether the grid keeps tables of bounds that suffice for the window.
bool has_bounds(const SearchLattice& lattice, int stride = ScoreGrid::kBoundStrides.back()) {
  const SearchWindow& window = lattice.window();
  return lattice.grid().bounds(stride, BoundLevel::blocks_of(window.n_x, stride),
                               BoundLevel::blocks_of(window.n_y, stride)) != nullptr;
}

// Returns whether an exhaustive search takes less time than the tables of bounds, which cover the cells that
// the scan can reach.
bool is_cheaper_exhaustively(const SearchLattice& lattice) {
  const SearchWindow& window = lattice.window();
  if (has_bounds(lattice)) return false;
  const ScoreLevel& grid = lattice.grid().finest();
  const double reach = lattice.scan().farthest_m / lattice.grid().resolution_m();
  const double cells = std::min(2 * (reach + window.n_x), double(grid.width())) *
                       std::min(2 * (reach + window.n_y), double(grid.height()));
  return window.poses() * static_cast<double>(lattice.points()) <= kScoresPerCell * cells;
}

// Keeps the best candidate of a search.
class BestPose {
 public:
  BestPose(std::uint32_t min_sum, const std::optional<ExcludedRegion>& excluded)
      : least_(min_sum), excluded_(excluded) {}

  // Smallest sum of a candidate that may still be the best.
  std::uint32_t least() const { return least_; }
  const std::optional<Candidate>& best() const { return best_; }

  void consider(const Candidate& candidate) {
    if (candidate.sum < least_) return;
    if (best_ && !candidate.better_than(*best_)) return;
    if (excluded_ && excluded_->contains(candidate.pose)) return;
    best_ = candidate;
    least_ = candidate.sum;
  }

  // Considers all poses of a block of sums at one heading.
  void consider(const ShiftSums& sums, const ShiftBlock& shifts, int theta) {
    for (int y = 0; y < shifts.height; ++y) {
      const std::uint32_t* row = sums.row(y);
      for (int x = 0; x < shifts.width; ++x)
        if (row[x] >= least_) consider({row[x], {shifts.first.x + x, shifts.first.y + y, theta}});
    }
  }

 private:
  std::uint32_t least_;
  const std::optional<ExcludedRegion>& excluded_;
  std::optional<Candidate> best_;
};

// A block of poses, by its place in its BoundLevel.
struct Block {
  std::uint32_t bound;
  int layer;
  int row;
  int column;
};

bool lower_bound_first(const Block& a, const Block& b) {
  return a.bound < b.bound;
}

// Returns whether a block is among blocks of its level.
bool is_among(const std::vector<Block>& blocks, const Block& block) {
  return std::any_of(blocks.begin(), blocks.end(), [&](const Block& one) {
    return one.layer == block.layer && one.row == block.row && one.column == block.column;
  });
}

}  // namespace

class ExactSearch::BranchAndBound {
 public:
  explicit BranchAndBound(const SearchLattice& lattice) : lattice_(lattice), window_(lattice.window()) {
    levels_.reserve(kStrides.size());
    const bool has_tables = has_bounds(lattice);
    for (const int stride : kStrides) {
      if (has_tables ? !has_bounds(lattice, stride)
                     : stride == kStrides.front() && window_.poses() <= kHugePoses)
        continue;
      levels_.emplace_back(lattice, stride);
    }
  }

  SearchOutcome find(std::uint32_t min_sum, const std::optional<ExcludedRegion>& excluded) {
    evaluations_ = 0;
    if (top_bounds_.empty()) bound_top_level();
    BestPose best(min_sum, excluded);
    for (const auto& [bound, layer] : layers_) {
      if (bound < best.least()) break;
      search(top_blocks(layer, best.least(), excluded), best);
    }
    return {best.best(), evaluations_, SearchKind::kBranchAndBound};
  }

 private:
  // Sides of the blocks, from coarse to fine. Single poses follow. Only huge windows use the first.
  static constexpr std::array<int, 3> kStrides = {16, 8, 4};
  static_assert(ScoreGrid::kBoundStrides.back() == kStrides.back());  // so there is always a level

  // Bounds all blocks of the first level, and sorts its layers by descending bounds.
  void bound_top_level() {
    BoundLevel& top = levels_.front();
    top_row_ = (top.columns() + kSumLanes - 1) / kSumLanes * kSumLanes;
    const std::size_t size = static_cast<std::size_t>(top_row_) * static_cast<std::size_t>(top.rows());
    top_bounds_.assign(size * static_cast<std::size_t>(top.layers()), 0);
    for (int layer = 0; layer < top.layers(); ++layer) {
      top.add_bounds(layer, {0, 0}, top.columns(), top.rows(), top_bounds(layer, 0), top_row_);
      std::uint32_t highest = 0;
      for (int row = 0; row < top.rows(); ++row)
        highest = std::max(highest,
                           *std::max_element(top_bounds(layer, row), top_bounds(layer, row) + top.columns()));
      layers_.emplace_back(highest, layer);
    }
    std::stable_sort(layers_.begin(), layers_.end(),
                     [](const auto& a, const auto& b) { return a.first > b.first; });
    evaluations_ += std::int64_t{top.layers()} * top.rows() * top.columns();
  }

  std::uint32_t* top_bounds(int layer, int row) {
    return top_bounds_.data() + (std::ptrdiff_t{layer} * levels_.front().rows() + row) * top_row_;
  }

  // Returns the blocks of a layer whose bounds reach `least` and which the excluded region does not contain.
  std::vector<Block> top_blocks(int layer, std::uint32_t least,
                                const std::optional<ExcludedRegion>& excluded) {
    const BoundLevel& top = levels_.front();
    std::vector<Block> blocks;
    for (int row = 0; row < top.rows(); ++row) {
      const std::uint32_t* bounds = top_bounds(layer, row);
      for (int column = 0; column < top.columns(); ++column) {
        const Block block = {bounds[column], layer, row, column};
        if (block.bound >= least && !(excluded && contains(*excluded, block))) blocks.push_back(block);
      }
    }
    return blocks;
  }

  // Returns whether the region contains a whole block of the first level.
  bool contains(const ExcludedRegion& excluded, const Block& block) const {
    const BoundLevel& top = levels_.front();
    const LatticePose first = {block.column * top.stride_cells() - window_.n_x,
                               block.row * top.stride_cells() - window_.n_y,
                               block.layer * top.headings() - window_.n_theta};
    const int to_last = top.stride_cells() - 1;
    return excluded.contains(first) &&
           excluded.contains({first.x + to_last, first.y + to_last, first.theta + top.headings() - 1});
  }

  // Searches blocks of the first level: descends to the best pose of the most promising block, then expands
  // all blocks whose bounds reach its sum. Repeats this with their children, level by level.
  void search(std::vector<Block> blocks, BestPose& best) {
    std::vector<Block> children;
    std::vector<Block> scored;  // blocks of the last level whose poses were scored by descents
    for (std::size_t level = 0; level < levels_.size() && !blocks.empty(); ++level) {
      const bool is_last = level + 1 == levels_.size();
      const auto is_closed = [&](const Block& block) {
        return block.bound < best.least() || (is_last && is_among(scored, block));
      };
      const auto most_promising = std::max_element(blocks.begin(), blocks.end(), lower_bound_first);
      if (!is_closed(*most_promising)) descend(*most_promising, level, best, scored);
      blocks.erase(std::remove_if(blocks.begin(), blocks.end(), is_closed), blocks.end());
      children.clear();
      for (auto first = blocks.cbegin(); first != blocks.cend();) {
        const auto last = std::find_if(first, blocks.cend(), [&](const Block& block) {
          return block.layer != first->layer || block.row != first->row;
        });
        expand_row(&*first, &*first + (last - first), level, best, children);
        first = last;
      }
      blocks.swap(children);
    }
  }

  // Descends from a block to the most promising of its children, and so on while one reaches best.least().
  // Scores the poses of the block of the last level, and appends that block to `scored`.
  void descend(Block block, std::size_t level, BestPose& best, std::vector<Block>& scored) {
    std::vector<Block> children;
    for (; level + 1 < levels_.size(); ++level) {
      children.clear();
      expand_row(&block, &block + 1, level, best, children);
      if (children.empty()) return;
      block = *std::max_element(children.begin(), children.end(), lower_bound_first);
    }
    if (is_among(scored, block)) return;
    score_row(&block, &block + 1, best);
    scored.push_back(block);
  }

  // Expands blocks of one row of a level, ordered by columns: appends the children whose bounds reach
  // best.least() to `children`, ordered by layers, rows and columns. The children of the last level are
  // poses, which `best` considers.
  void expand_row(const Block* first, const Block* last, std::size_t level, BestPose& best,
                  std::vector<Block>& children) {
    if (level + 1 == levels_.size()) {
      score_row(first, last, best);
      return;
    }
    const BoundLevel& parents = levels_[level];
    BoundLevel& finer = levels_[level + 1];
    const int side = parents.stride_cells() / finer.stride_cells();
    const int row = first->row * side;
    const int height = std::min(side, finer.rows() - row);
    const int layers = parents.headings() / finer.headings();
    const std::ptrdiff_t bounds_row = finer.columns() + kSumLanes;
    for (int layer = first->layer * layers; layer < std::min((first->layer + 1) * layers, finer.layers());
         ++layer) {
      bounds_.assign(static_cast<std::size_t>(bounds_row * height), 0);
      for_each_run(first, last, side, finer.columns(), [&](int column, int width) {
        finer.add_bounds(layer, {column, row}, width, height, bounds_.data() + column, bounds_row);
        evaluations_ += std::int64_t{width} * height;
      });
      const int end = std::min((last[-1].column + 1) * side, finer.columns());
      for (int y = 0; y < height; ++y)
        for (int x = first->column * side; x < end; ++x)
          if (const std::uint32_t bound = bounds_[static_cast<std::size_t>(y * bounds_row + x)];
              bound >= best.least())
            children.push_back({bound, layer, row + y, x});
    }
  }

  // Scores the poses of blocks of one row of the last level.
  void score_row(const Block* first, const Block* last, BestPose& best) {
    const BoundLevel& level = levels_.back();
    const int side = level.stride_cells();
    const int row = first->row * side;
    const int height = std::min(side, 2 * window_.n_y + 1 - row);
    const int turn = first->layer * level.headings();
    for (int theta = turn - window_.n_theta;
         theta < std::min(turn + level.headings() - window_.n_theta, window_.n_theta + 1); ++theta) {
      for_each_run(first, last, side, 2 * window_.n_x + 1, [&](int column, int width) {
        const ShiftBlock shifts = {{column - window_.n_x, row - window_.n_y}, width, height};
        sums_.compute(lattice_.grid().finest(), lattice_.cells(theta), lattice_.points(), shifts.first, width,
                      height);
        best.consider(sums_, shifts, theta);
        evaluations_ += std::int64_t{width} * height;
      });
    }
  }

  // Covers the children of blocks of one row by few runs of at most kSumLanes columns, which the sum kernel
  // evaluates together. Calls visit(column, width) for each run. `side` is the number of children of a block
  // along each axis, `columns` that of all children in the row.
  template <class Visit>
  static void for_each_run(const Block* first, const Block* last, int side, int columns, const Visit& visit) {
    while (first != last) {
      const Block* end = first;
      while (end != last && (end->column + 1 - first->column) * side <= kSumLanes) ++end;
      const int column = first->column * side;
      visit(column, std::min((end[-1].column + 1) * side, columns) - column);
      first = end;
    }
  }

  const SearchLattice& lattice_;
  const SearchWindow& window_;
  std::vector<BoundLevel> levels_;
  std::vector<std::uint32_t> top_bounds_;              // bounds of the first level by layer, row and column
  std::ptrdiff_t top_row_ = 0;                         // elements of top_bounds_ from one row to the next
  std::vector<std::pair<std::uint32_t, int>> layers_;  // highest bound and number of each layer
  std::vector<std::uint32_t> bounds_;
  ShiftSums sums_;
  std::int64_t evaluations_ = 0;
};

ExactSearch::ExactSearch(const SearchLattice& lattice) : lattice_(lattice) {}
ExactSearch::~ExactSearch() = default;

SearchOutcome ExactSearch::find(std::uint32_t min_sum, const std::optional<ExcludedRegion>& excluded) {
  if (is_cheaper_exhaustively(lattice_)) return exhaustive_search(lattice_, min_sum, excluded);
  if (!branch_and_bound_) branch_and_bound_ = std::make_unique<BranchAndBound>(lattice_);
  return branch_and_bound_->find(min_sum, excluded);
}

void ExactSearch::find_next(const PeakRequest& request, FoundPeaks& peaks) {
  if (!peaks.best || !request.next) return;
  const ExcludedRegion around = {peaks.best->pose, request.next->cells, request.next->turns};
  const auto least = static_cast<std::uint32_t>(std::ceil(request.next->share * peaks.best->sum));
  const SearchOutcome next = find(least, around);
  peaks.next = next.best;
  peaks.evaluations += next.evaluations;
}

SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded) {
  const SearchWindow& window = lattice.window();
  const ShiftBlock all = {{-window.n_x, -window.n_y}, 2 * window.n_x + 1, 2 * window.n_y + 1};
  BestPose best(min_sum, excluded);
  ShiftSums sums;
  std::int64_t evaluations = 0;
  const auto score = [&](int theta, const ShiftBlock& shifts) {
    if (shifts.width <= 0 || shifts.height <= 0) return;
    sums.compute(lattice.grid().finest(), lattice.cells(theta), lattice.points(), shifts.first, shifts.width,
                 shifts.height);
    best.consider(sums, shifts, theta);
    evaluations += static_cast<std::int64_t>(shifts.width) * shifts.height;
  };
  for (int theta = -window.n_theta; theta <= window.n_theta; ++theta) {
    if (!excluded) {
      score(theta, all);
      continue;
    }
    for (const ShiftBlock& strip : outside(*excluded, theta, all)) score(theta, strip);
  }
  return {best.best(), evaluations, SearchKind::kExhaustive};
}

SearchOutcome branch_and_bound_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                      const std::optional<ExcludedRegion>& excluded) {
  return ExactSearch::BranchAndBound(lattice).find(min_sum, excluded);
}

bool needs_exact_next(const SearchWindow& window) {
  return window.n_x <= 32 && window.n_y <= 32;
}

}  // namespace psi_slam
