// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_search.h"

#include <tuple>
#include <vector>

#include "matching/pose_code.h"

namespace psi_slam {
namespace {

class Search {
 public:
  Search(const SearchLattice& lattice, const PeakRequest& request, const PaperGeneticOptions& options)
      : lattice_(lattice),
        request_(request),
        options_(options),
        code_(lattice.window()),
        random_(random_for(request.seed)) {}

  FoundPeaks run() {
    std::vector<Chromosome> population(static_cast<std::size_t>(options_.population));
    for (Chromosome& one : population) one = random_() >> (64 - code_.bits());
    score(population);
    for (int generation = 1; generation < options_.generations; ++generation) {
      population = offspring(population);
      score(population);
    }
    peaks_.generations = options_.generations;
    pick_peaks(scored_, request_, peaks_);
    return peaks_;
  }

 private:
  void score(const std::vector<Chromosome>& population) {
    fitness_.clear();
    for (const Chromosome chromosome : population) {
      const LatticePose pose = code_.decode(chromosome);
      sums_.compute(lattice_.grid().finest(), lattice_.cells(pose.theta), lattice_.points(), {pose.x, pose.y},
                    1, 1);
      const std::uint32_t sum = sums_.row(0)[0];
      scored_.push_back({sum, pose});
      fitness_.push_back(lattice_.response(sum));
      ++peaks_.evaluations;
    }
  }

  std::vector<Chromosome> offspring(const std::vector<Chromosome>& parents) {
    const RouletteWheel wheel(fitness_);
    std::vector<Chromosome> children;
    while (children.size() < parents.size()) {
      Chromosome a = parents[wheel.spin(random_)];
      Chromosome b = parents[wheel.spin(random_)];
      if (draw_unit(random_) < options_.crossover_rate)
        std::tie(a, b) = two_point_crossover(a, b, code_.bits(), random_);
      children.push_back(mutate(a, code_.bits(), options_.mutation_rate, random_));
      if (children.size() < parents.size())
        children.push_back(mutate(b, code_.bits(), options_.mutation_rate, random_));
    }
    return children;
  }

  const SearchLattice& lattice_;
  const PeakRequest& request_;
  const PaperGeneticOptions& options_;
  PoseCode code_;
  Random random_;
  ShiftSums sums_;
  std::vector<double> fitness_;
  std::vector<Candidate> scored_;
  FoundPeaks peaks_;
};

}  // namespace

FoundPeaks paper_genetic_search(const SearchLattice& lattice, const PeakRequest& request,
                                const PaperGeneticOptions& options) {
  return Search(lattice, request, options).run();
}

}  // namespace psi_slam
