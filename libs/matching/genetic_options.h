// SPDX-License-Identifier: BSD-3-Clause
// Options of the genetic searches. Each idea has its own switch, so that its benefit can be measured.
#pragma once

namespace psi_slam {

/// The genetic algorithm of the paper, section 3.1, equations 9 to 12.
struct PaperGeneticOptions {
  int population = 200;
  int generations = 100;
  double crossover_rate = 0.6;  ///< the paper advises to lower it
  double mutation_rate = 0.05;  ///< per bit; the paper advises to raise it
};

/// Options beyond the paper. An individual is a tile (see TileSpace): a heading and a block of neighbouring
/// shifts. Numbers of individuals are capped at an eighth of all tiles, so that small windows stay cheap.
struct MemeticGeneticOptions {
  int population = 128;
  int children = 32;  ///< per generation
  int elite = 32;     ///< best individuals kept from generation to generation; 0: none
  int generations = 4;
  int patience = 2;  ///< stops after this many generations without improvement; 0: never
  double crossover_rate = 0.5;
  double mutation_rate = 0.1;  ///< per bit
  bool gray_code = true;       ///< a step in space flips one bit; false: the paper's binary code
  bool niches = true;          ///< keeps one individual per neighbourhood, so that several peaks survive
  bool remember = true;        ///< scores a chromosome only once
  bool pooled_fitness = true;  ///< evolves on the max-pooled grid first
  int descents = 64;           ///< best individuals of a generation that descend along the heading
  int polished = 3;            ///< best poses whose neighbourhood is searched exactly at the end
  bool seed_coarse = true;     ///< takes the first generation from a sparse coarse search; false: random
  int seeds = 512;             ///< largest number of individuals from the sparse coarse search
  int seed_points = 100;       ///< points of the scan that the sparse coarse search sums
  int heading_stride = 4;      ///< angular steps between headings of the sparse search and of coarse cells
};

/// Options of the coarse stage of "csm_ga".
struct CoarseCellOptions {
  int cells = 2048;  ///< best coarse cells that the genetic search covers
};

enum class GeneticVariant { kPaper, kMemetic };

struct GeneticOptions {
  GeneticVariant variant = GeneticVariant::kMemetic;
  PaperGeneticOptions paper;
  MemeticGeneticOptions memetic;
  CoarseCellOptions coarse;
};

}  // namespace psi_slam
