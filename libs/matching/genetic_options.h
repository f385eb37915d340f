// SPDX-License-Identifier: BSD-3-Clause
// The options of the genetic searches, each a switch of its own, so that the worth of every idea can be
// measured (method, section 5).
#pragma once

namespace psi_slam {

/// The paper's GA, exactly: equations 9 to 12, section 3.1.
struct PaperGeneticOptions {
  int population = 200;
  int generations = 100;
  /// The paper advises to lower the crossover rate and to raise the mutation rate.
  double crossover_rate = 0.6;
  double mutation_rate = 0.05;  ///< of each bit
};

/// What goes beyond the paper. An individual is a tile (see TileSpace): a heading and a block of neighbouring
/// shifts. Numbers of individuals are capped at an eighth of all tiles, so that small windows stay cheap.
struct MemeticGeneticOptions {
  int population = 128;
  int children = 32;  ///< a generation
  int elite = 32;     ///< best ones kept from generation to generation; 0: none
  int generations = 4;
  int patience = 2;  ///< stop after so many generations without a better one; 0: never
  double crossover_rate = 0.5;
  double mutation_rate = 0.1;  ///< of each bit
  bool gray_code = true;       ///< a step in space is one bit; false: the paper's binary code
  bool niches = true;          ///< one individual a neighbourhood, so that two corridors both survive
  bool remember = true;        ///< a chromosome met before is not scored again
  bool pooled_fitness = true;  ///< evolves on the max-pooled grid first
  int descents = 64;           ///< best ones of a generation that descend along the heading
  int polished = 3;            ///< best poses whose neighbourhood is searched exactly at the end
  bool seed_coarse = true;     ///< the first generation comes of a sparse coarse search; false: random
  int seeds = 512;             ///< at most, of that search
  int seed_points = 100;       ///< of the scan, that it looks at
  int heading_stride = 4;      ///< every so many headings: of the sparse search, and of coarse cells
};

/// The rough stage of "csm_ga".
struct CoarseCellOptions {
  int cells = 2048;  ///< best ones that the genetic search looks into
};

enum class GeneticVariant { kPaper, kMemetic };

struct GeneticOptions {
  GeneticVariant variant = GeneticVariant::kMemetic;
  PaperGeneticOptions paper;
  MemeticGeneticOptions memetic;
  CoarseCellOptions coarse;
};

}  // namespace psi_slam
