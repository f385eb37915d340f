// SPDX-License-Identifier: BSD-3-Clause
#include "matching/exact_search.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

namespace psi_slam {
namespace {

// Windows with at most this many poses are searched exhaustively, because the pyramid costs more than it
// saves.
constexpr std::int64_t kExhaustivePoses = 60'000;
constexpr int kCoarse = ScoreGrid::kStrides[1];
constexpr int kMiddle = ScoreGrid::kStrides[0];

// A block of shifts at one heading. It begins at `pose`, and its side is the stride of its pyramid level.
struct Block {
  std::uint32_t bound;
  LatticePose pose;
};

// Base class of both searches. Keeps the best candidate.
class SearchBase {
 public:
  SearchBase(const SearchLattice& lattice, std::uint32_t min_sum,
             const std::optional<ExcludedRegion>& excluded)
      : lattice_(lattice), window_(lattice.window()), excluded_(excluded) {
    best_.sum = min_sum;
  }

 protected:
  void consider(const Candidate& candidate) {
    if (candidate.sum < best_.sum) return;
    if (outcome_.best && !candidate.better_than(best_)) return;
    if (excluded_ && excluded_->contains(candidate.pose)) return;
    best_ = candidate;
    outcome_.best = candidate;
  }

  const SearchLattice& lattice_;
  const SearchWindow& window_;
  const std::optional<ExcludedRegion>& excluded_;
  Candidate best_;
  ShiftSums sums_;
  SearchOutcome outcome_;
};

class ExhaustiveSearch : private SearchBase {
 public:
  using SearchBase::SearchBase;

  SearchOutcome run() {
    const ShiftBlock all = {{-window_.n_x, -window_.n_y}, 2 * window_.n_x + 1, 2 * window_.n_y + 1};
    for (int theta = -window_.n_theta; theta <= window_.n_theta; ++theta) {
      if (!excluded_) {
        score(theta, all);
        continue;
      }
      for (const ShiftBlock& strip : outside(*excluded_, theta, all)) score(theta, strip);
    }
    return outcome_;
  }

 private:
  void score(int theta, const ShiftBlock& shifts) {
    if (shifts.width <= 0 || shifts.height <= 0) return;
    sums_.compute(lattice_.grid().finest(), lattice_.cells(theta), lattice_.points(), shifts.first,
                  shifts.width, shifts.height);
    for (int y = 0; y < shifts.height; ++y) {
      const std::uint32_t* row = sums_.row(y);
      for (int x = 0; x < shifts.width; ++x)
        if (row[x] >= best_.sum) consider({row[x], {shifts.first.x + x, shifts.first.y + y, theta}});
    }
    outcome_.evaluations += static_cast<std::int64_t>(shifts.width) * shifts.height;
  }
};

class BranchAndBound : private SearchBase {
 public:
  using SearchBase::SearchBase;

  SearchOutcome run() {
    for (const Block& block : coarse_blocks()) {
      if (block.bound < best_.sum) break;
      expand(block);
    }
    return outcome_;
  }

 private:
  // Returns all blocks of the window whose bound reaches the smallest sum, in descending order of bounds.
  std::vector<Block> coarse_blocks() {
    const int width = (2 * window_.n_x + kCoarse) / kCoarse;
    const int height = (2 * window_.n_y + kCoarse) / kCoarse;
    std::vector<Block> blocks;
    for (int theta = -window_.n_theta; theta <= window_.n_theta; ++theta) {
      sums_.compute(lattice_.grid().pyramid(1), lattice_.cells(theta), lattice_.points(),
                    {-window_.n_x, -window_.n_y}, width, height);
      for (int y = 0; y < height; ++y) {
        const std::uint32_t* row = sums_.row(y);
        for (int x = 0; x < width; ++x)
          if (row[x] >= best_.sum)
            blocks.push_back({row[x], {x * kCoarse - window_.n_x, y * kCoarse - window_.n_y, theta}});
      }
      outcome_.evaluations += static_cast<std::int64_t>(width) * height;
    }
    std::stable_sort(blocks.begin(), blocks.end(),
                     [](const Block& a, const Block& b) { return a.bound > b.bound; });
    return blocks;
  }

  void expand(const Block& block) {
    constexpr int kSide = kCoarse / kMiddle;
    sums_.compute(lattice_.grid().pyramid(0), lattice_.cells(block.pose.theta), lattice_.points(),
                  {block.pose.x, block.pose.y}, kSide, kSide);
    outcome_.evaluations += kSide * kSide;
    Block children[kSide * kSide];
    int count = 0;
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) {
        const LatticePose pose = {block.pose.x + x * kMiddle, block.pose.y + y * kMiddle, block.pose.theta};
        if (sums_.row(y)[x] < best_.sum || pose.x > window_.n_x || pose.y > window_.n_y) continue;
        children[count++] = {sums_.row(y)[x], pose};
      }
    }
    std::stable_sort(children, children + count,
                     [](const Block& a, const Block& b) { return a.bound > b.bound; });
    for (int i = 0; i < count && children[i].bound >= best_.sum; ++i) score(children[i]);
  }

  void score(const Block& block) {
    sums_.compute(lattice_.grid().finest(), lattice_.cells(block.pose.theta), lattice_.points(),
                  {block.pose.x, block.pose.y}, kMiddle, kMiddle);
    outcome_.evaluations += kMiddle * kMiddle;
    for (int y = 0; y < kMiddle && block.pose.y + y <= window_.n_y; ++y)
      for (int x = 0; x < kMiddle && block.pose.x + x <= window_.n_x; ++x)
        consider({sums_.row(y)[x], {block.pose.x + x, block.pose.y + y, block.pose.theta}});
  }
};

}  // namespace

SearchOutcome exhaustive_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                const std::optional<ExcludedRegion>& excluded) {
  return ExhaustiveSearch(lattice, min_sum, excluded).run();
}

SearchOutcome branch_and_bound_search(const SearchLattice& lattice, std::uint32_t min_sum,
                                      const std::optional<ExcludedRegion>& excluded) {
  if (!lattice.grid().has_pyramid())
    throw std::invalid_argument("branch and bound needs the score grid's pyramid");
  SearchOutcome outcome = BranchAndBound(lattice, min_sum, excluded).run();
  outcome.search = SearchKind::kBranchAndBound;
  return outcome;
}

SearchOutcome exact_search(const SearchLattice& lattice, std::uint32_t min_sum,
                           const std::optional<ExcludedRegion>& excluded) {
  const SearchWindow& window = lattice.window();
  const std::int64_t poses =
      static_cast<std::int64_t>(2 * window.n_x + 1) * (2 * window.n_y + 1) * (2 * window.n_theta + 1);
  const bool exhaustive = poses <= kExhaustivePoses || !lattice.grid().has_pyramid();
  return exhaustive ? exhaustive_search(lattice, min_sum, excluded)
                    : branch_and_bound_search(lattice, min_sum, excluded);
}

void find_next_exactly(const SearchLattice& lattice, const PeakRequest& request, FoundPeaks& peaks) {
  if (!peaks.best || !request.next) return;
  const ExcludedRegion around = {peaks.best->pose, request.next->cells, request.next->turns};
  const auto least = static_cast<std::uint32_t>(std::ceil(request.next->share * peaks.best->sum));
  const SearchOutcome next = exact_search(lattice, least, around);
  peaks.next = next.best;
  peaks.evaluations += next.evaluations;
}

bool needs_exact_next(const SearchWindow& window) {
  return window.n_x <= 32 && window.n_y <= 32;
}

}  // namespace psi_slam
