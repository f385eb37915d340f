// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_search.h"

#include <algorithm>
#include <cstdlib>
#include <stdexcept>
#include <tuple>
#include <unordered_map>
#include <utility>

#include "matching/coarse_search.h"

namespace psi_slam {
namespace {

constexpr double kCrossoverRate = 0.5;  // probability per pair of parents
constexpr int kDescents = 64;           // number of best individuals improved by a descent in each generation
constexpr std::size_t kPolished = 3;  // number of best poses that an exact search nearby improves at the end

struct Individual {
  Chromosome chromosome = 0;
  Candidate best;  // best pose of the individual's tile
};

bool fitter(const Individual& a, const Individual& b) {
  if (a.best.sum != b.best.sum) return a.best.sum > b.best.sum;
  return a.chromosome < b.chromosome;
}

bool spans(const SearchWindow& window, const ShiftBlock& block) {
  return block.width == 2 * window.n_x + 1 && block.height == 2 * window.n_y + 1;
}

class Evolution {
 public:
  Evolution(const SearchLattice& lattice, const TileSpace& space, const PeakRequest& request,
            const MemeticGeneticOptions& options, Random& random)
      : lattice_(lattice),
        space_(space),
        request_(request),
        options_(options),
        random_(random),
        scorer_(lattice),
        whole_(spans(lattice.window(), space.tile(0).block)) {}

  FoundPeaks run(std::vector<Chromosome> chromosomes) {
    if (whole_) {
      search_headings(chromosomes);
      return finish();
    }
    evolve(chromosomes, TileLevel::kPooled);
    if (population_.front().best.sum < request_.min_sum) return finish();  // no pose reaches min_sum
    chromosomes.clear();
    for (const Individual& one : population_) chromosomes.push_back(one.chromosome);
    evolve(chromosomes, TileLevel::kFinest);
    polish();
    return finish();
  }

 private:
  std::size_t size(int count) const {
    return static_cast<std::size_t>(
        std::min<std::int64_t>(count, std::max<std::int64_t>(1, space_.size() / 8)));
  }

  void evolve(const std::vector<Chromosome>& chromosomes, TileLevel level) {
    level_ = level;
    known_.clear();
    population_.clear();
    for (const Chromosome chromosome : chromosomes) population_.push_back(born(chromosome));
    select();
    descend();
    int still = 0;
    for (int generation = 0; generation < options_.generations; ++generation) {
      const std::uint32_t best = population_.front().best.sum;
      std::vector<Individual> next = offspring();
      next.insert(next.end(), population_.begin(),
                  population_.begin() +
                      static_cast<std::ptrdiff_t>(std::min(population_.size(), size(options_.elite))));
      population_ = std::move(next);
      select();
      descend();
      ++generations_;
      still = population_.front().best.sum > best ? 0 : still + 1;
      if (options_.patience > 0 && still >= options_.patience) break;
    }
  }

  // Searches a window of one tile, where only the heading varies. Local searches from the best headings
  // replace the generations. Stops at the first heading whose upper bound is below the best sum found. A grid
  // without a pyramid has no upper bounds.
  void search_headings(const std::vector<Chromosome>& chromosomes) {
    const bool has_bounds = lattice_.grid().has_pyramid();
    level_ = has_bounds ? TileLevel::kPooled : TileLevel::kFinest;
    for (const Chromosome chromosome : chromosomes) population_.push_back(born(chromosome));
    std::sort(population_.begin(), population_.end(), fitter);
    population_.resize(std::min(population_.size(), size(options_.population)));
    known_.clear();
    level_ = TileLevel::kFinest;
    std::uint32_t found = request_.min_sum;
    for (const Individual& seed : population_) {
      if (has_bounds && seed.best.sum < found) break;
      Individual one = scored(seed.chromosome);
      descend(one);
      found = std::max(found, one.best.sum);
    }
  }

  Individual born(Chromosome chromosome) { return scored(space_.repaired(chromosome)); }

  // Scores each chromosome at most once per level.
  Individual scored(Chromosome chromosome) {
    const auto [known, is_new] = known_.try_emplace(chromosome);
    if (is_new) known->second = score(chromosome);
    return {chromosome, known->second};
  }

  Candidate score(Chromosome chromosome) {
    const Candidate best = scorer_.score(space_.tile(chromosome), level_);
    if (level_ == TileLevel::kFinest) scored_.push_back(best);
    return best;
  }

  // Keeps the fittest individuals up to the size of the population, at most one per neighbourhood.
  void select() {
    std::sort(population_.begin(), population_.end(), fitter);
    std::vector<Individual> kept;
    for (const Individual& one : population_) {
      if (kept.size() == size(options_.population)) break;
      if (!crowded(one, kept)) kept.push_back(one);
    }
    population_ = std::move(kept);
  }

  bool crowded(const Individual& one, const std::vector<Individual>& others) const {
    return std::any_of(others.begin(), others.end(),
                       [&](const Individual& other) { return near(one.best, other.best); });
  }

  bool near(const Candidate& a, const Candidate& b) const {
    return std::abs(a.pose.theta - b.pose.theta) <= kHeadingStride &&
           std::abs(a.pose.x - b.pose.x) <= WindowTiles::kSide &&
           std::abs(a.pose.y - b.pose.y) <= WindowTiles::kSide;
  }

  // Returns a new generation. The roulette wheel uses ranks, because responses differ too little.
  std::vector<Individual> offspring() {
    std::vector<double> ranks;
    for (std::size_t i = population_.size(); i > 0; --i) ranks.push_back(static_cast<double>(i));
    const RouletteWheel wheel(ranks);
    std::vector<Individual> children;
    while (children.size() < size(options_.children)) {
      Chromosome a = population_[wheel.spin(random_)].chromosome;
      Chromosome b = population_[wheel.spin(random_)].chromosome;
      if (draw_unit(random_) < kCrossoverRate)
        std::tie(a, b) = two_point_crossover(a, b, space_.bits(), random_);
      for (const Chromosome child : {a, b})
        children.push_back(born(mutate(child, space_.bits(), options_.mutation_rate, random_)));
    }
    return children;
  }

  // Improves the best individuals by a pattern search along the heading. Each chromosome takes over the
  // heading found (Lamarckian evolution).
  void descend() {
    const std::size_t count = std::min(population_.size(), size(kDescents));
    for (std::size_t i = 0; i < count; ++i) descend(population_[i]);
    std::sort(population_.begin(), population_.end(), fitter);
  }

  void descend(Individual& one) {
    for (int step = kHeadingStride / 2; step >= 1;)
      if (!turn_if_fitter(one, step) && !turn_if_fitter(one, -step)) step /= 2;
  }

  bool turn_if_fitter(Individual& one, int steps) {
    const std::optional<Chromosome> turned = space_.turned(one.chromosome, steps);
    if (!turned) return false;
    const Individual there = scored(*turned);
    if (there.best.sum <= one.best.sum) return false;
    one = there;
    return true;
  }

  // Improves the best poses, one per neighbourhood: searches exactly around each pose, also across tile
  // borders, and moves there until no pose nearby is better.
  void polish() {
    std::vector<Candidate> ranked = scored_;
    std::sort(ranked.begin(), ranked.end(),
              [](const Candidate& a, const Candidate& b) { return a.better_than(b); });
    std::vector<Candidate> best;
    for (const Candidate& one : ranked) {
      if (best.size() >= kPolished) break;
      if (std::none_of(best.begin(), best.end(), [&](const Candidate& other) { return near(one, other); }))
        best.push_back(one);
    }
    for (Candidate& one : best) {
      while (move_if_better(one, 0) || move_if_better(one, 1) || move_if_better(one, -1)) {
      }
      scored_.push_back(one);
    }
  }

  bool move_if_better(Candidate& one, int turn) {
    const int theta = one.pose.theta + turn;
    if (std::abs(theta) > lattice_.window().n_theta) return false;
    const Candidate near = scorer_.best_near({one.pose.x, one.pose.y, theta});
    if (!near.better_than(one)) return false;
    one = near;
    return true;
  }

  FoundPeaks finish() {
    FoundPeaks peaks;
    peaks.evaluations = scorer_.evaluations();
    peaks.generations = generations_;
    pick_peaks(scored_, request_, peaks);
    return peaks;
  }

  const SearchLattice& lattice_;
  const TileSpace& space_;
  const PeakRequest& request_;
  const MemeticGeneticOptions& options_;
  Random& random_;
  TileScorer scorer_;
  bool whole_;  // whether tiles are as large as the window
  TileLevel level_ = TileLevel::kFinest;
  std::vector<Individual> population_;
  std::unordered_map<Chromosome, Candidate> known_;
  std::vector<Candidate> scored_;  // candidates scored on the finest level
  int generations_ = 0;
};

}  // namespace

FoundPeaks evolve_tiles(const SearchLattice& lattice, const TileSpace& space,
                        const std::vector<Chromosome>& first_generation, const PeakRequest& request,
                        const MemeticGeneticOptions& options, Random& random) {
  return Evolution(lattice, space, request, options, random).run(first_generation);
}

FoundPeaks memetic_search(const SearchLattice& lattice, const PeakRequest& request,
                          const MemeticGeneticOptions& options) {
  const WindowTiles tiles(lattice.window());
  const bool one_block = tiles.columns() * tiles.rows() == 1;
  if (!one_block && !lattice.grid().has_pyramid())
    throw std::invalid_argument("the memetic search needs the score grid's pyramid");
  Random random = random_for(request.seed);
  const Seeds seeds = coarse_seeds(lattice, tiles, options, random);
  FoundPeaks peaks = evolve_tiles(lattice, tiles, seeds.chromosomes, request, options, random);
  peaks.evaluations += seeds.evaluations;
  return peaks;
}

}  // namespace psi_slam
