// SPDX-License-Identifier: BSD-3-Clause
// Options of the genetic searches.
#pragma once

namespace psi_slam {

/// Options of the paper's genetic algorithm, section 3.1, equations 9 to 12. The paper gives no values. It
/// advises a low rate of crossover and a high one of mutation.
struct PaperGeneticOptions {
  int population = 200;
  int generations = 100;
  double crossover_rate = 0.6;  ///< probability per pair of parents
  double mutation_rate = 0.05;  ///< probability per bit
};

/// Options of the memetic search, which extends the paper's algorithm. An individual is a tile (see
/// TileSpace): a heading and a block of neighbouring shifts. `population`, `children` and `elite` are limited
/// to an eighth of all tiles, which keeps searches of small windows cheap.
struct MemeticGeneticOptions {
  int population = 128;  ///< number of individuals, one in each neighbourhood, so that many peaks survive
  int children = 32;     ///< number of children per generation
  int elite = 32;        ///< number of best individuals that survive; without any, a quarter of loops is lost
  int generations = 4;   ///< without any, a third of the time is saved, but one loop in 250 is lost
  /// Stops after this many generations without improvement, which saves a fifth of the time; 0: never.
  int patience = 2;
  double mutation_rate = 0.1;  ///< probability per bit; changes one or two bits of a child
  int seeds = 512;             ///< largest size of the first generation, found by a sparse coarse search
  int seed_points = 100;  ///< approximate number of points that this search sums, however many a scan has
};

enum class GeneticVariant { kPaper, kMemetic };

struct GeneticOptions {
  GeneticVariant variant = GeneticVariant::kMemetic;
  PaperGeneticOptions paper;
  MemeticGeneticOptions memetic;
};

}  // namespace psi_slam
