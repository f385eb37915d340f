// SPDX-License-Identifier: BSD-3-Clause
// Options of the genetic searches. Each addition to the paper's algorithm has its own switch, so its benefit
// can be measured.
#pragma once

namespace psi_slam {

/// Options of the paper's genetic algorithm, section 3.1, equations 9 to 12.
struct PaperGeneticOptions {
  int population = 200;
  int generations = 100;
  double crossover_rate = 0.6;  ///< probability per pair of parents; the paper advises less than usual
  double mutation_rate = 0.05;  ///< probability per bit; the paper advises more than usual
};

/// Options of the memetic search, which extends the paper's algorithm. An individual is a tile (see
/// TileSpace): a heading and a block of neighbouring shifts. `population`, `children`, `elite` and `descents`
/// are limited to an eighth of all tiles, which keeps searches of small windows cheap.
struct MemeticGeneticOptions {
  int population = 128;
  int children = 32;  ///< number of children per generation
  int elite = 32;     ///< number of best individuals that survive a generation
  int generations = 4;
  int patience = 2;  ///< stops after this many generations without improvement; 0: never stops early
  double crossover_rate = 0.5;
  double mutation_rate = 0.1;  ///< probability per bit
  bool gray_code = true;  ///< codes of neighbouring tiles differ in one bit; false: the paper's binary code
  bool niches = true;     ///< keeps only one individual per neighbourhood, so several peaks survive
  bool remember = true;   ///< scores each chromosome at most once per pyramid level
  bool pooled_fitness = true;  ///< evolves on the pyramid's first level before the finest grid
  int descents = 64;           ///< number of best individuals improved by a local search along the heading
  int polished = 3;            ///< number of best poses that an exact search nearby improves at the end
  bool seed_coarse = true;     ///< takes the first generation from a sparse coarse search; false: random
  int seeds = 512;             ///< largest number of tiles from the sparse coarse search
  int seed_points = 100;       ///< approximate number of points that the sparse coarse search sums
  int heading_stride = 4;  ///< angular steps between headings of the sparse coarse search and of coarse cells
};

/// Options of the coarse stage of "csm_ga".
struct CoarseCellOptions {
  int cells = 2048;  ///< number of best coarse cells that the genetic search covers
};

enum class GeneticVariant { kPaper, kMemetic };

struct GeneticOptions {
  GeneticVariant variant = GeneticVariant::kMemetic;
  PaperGeneticOptions paper;
  MemeticGeneticOptions memetic;
  CoarseCellOptions coarse;
};

}  // namespace psi_slam
