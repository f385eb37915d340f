// SPDX-License-Identifier: BSD-3-Clause
#include "matching/genetic_search.h"

#include <gtest/gtest.h>

#include <functional>
#include <random>
#include <stdexcept>
#include <thread>
#include <utility>

#include "matching/exact_search.h"
#include "real_scans.h"
#include "score_grids.h"
#include "slow_search.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

struct Room {
  SimulatedWalls walls = furnished_room();
  ScoreGrid grid = grid_of(walls);
  std::mt19937_64 random{111};
  ScanPoints scan = scan_of(walls, {4, 3, 0.5}, 180, 0.01, random);
  SearchLattice lattice{grid, scan, {5.5, 1.8, 0.2}, make_search_window({3, 3, 0.5}, 0.05, scan.farthest_m)};
};

PeakRequest request_of(std::uint64_t seed, std::uint32_t min_sum = 0) {
  PeakRequest request;
  request.min_sum = min_sum;
  request.seed = {seed, 5, 6};
  return request;
}

TEST(MemeticSearch, its_best_pose_has_the_returned_sum) {
  const Room room;
  const FoundPeaks peaks = memetic_search(room.lattice, request_of(1), {});
  ASSERT_TRUE(peaks.best);
  EXPECT_EQ(peaks.best->sum, slow_sum(room.lattice, peaks.best->pose));
  EXPECT_GT(peaks.evaluations, 0);
  EXPECT_GT(peaks.generations, 0);
}

TEST(MemeticSearch, every_option_changes_the_search_and_no_result_exceeds_the_best) {
  const Room room;
  const std::optional<Candidate> best = branch_and_bound_search(room.lattice, 0).best;
  const std::pair<const char*, std::function<void(MemeticGeneticOptions&)>> changes[] = {
      {"no elite", [](auto& options) { options.elite = 0; }},
      {"no mutation", [](auto& options) { options.mutation_rate = 0; }},
      {"no generations", [](auto& options) { options.generations = 0; }},
      {"patient", [](auto& options) { options.patience = 0; }},
      {"few seeds", [](auto& options) { options.seeds = 8; }},
      {"few points", [](auto& options) { options.seed_points = 20; }},
      {"small population", [](auto& options) { options.population = 4; }},
      {"few children", [](auto& options) { options.children = 4; }}};
  for (const auto& [name, change] : changes) {
    SCOPED_TRACE(name);
    MemeticGeneticOptions options;
    change(options);
    bool changed = false;
    for (std::uint64_t seed = 0; seed < 3; ++seed) {
      const FoundPeaks usual = memetic_search(room.lattice, request_of(seed), {});
      const FoundPeaks peaks = memetic_search(room.lattice, request_of(seed), options);
      ASSERT_TRUE(peaks.best);
      EXPECT_EQ(peaks.best->sum, slow_sum(room.lattice, peaks.best->pose));
      EXPECT_FALSE(peaks.best->better_than(*best));
      changed = changed || peaks.evaluations != usual.evaluations;
    }
    EXPECT_TRUE(changed) << "the option has no effect";
  }
}

TEST(MemeticSearch, nearly_always_finds_the_best_pose_of_real_scans) {
  const auto log = real_log();
  if (!log) GTEST_SKIP() << kNeedsRealScans;
  const RealScans real = read_real_scans(*log);
  ASSERT_FALSE(real.maps.empty());
  std::mt19937_64 random(112);
  std::uniform_real_distribution<double> share(-0.7, 0.7);
  int cases = 0;
  int same_sum = 0;
  std::int64_t evaluations = 0;
  std::int64_t poses = 0;
  for (int trial = 0; trial < 40; ++trial) {
    const PlacedLocalMap& placed = real.maps[random() % real.maps.size()];
    const std::size_t node = placed.first_node + random() % (placed.last_node - placed.first_node + 1);
    const ScanPoints& scan = *real.nodes[node].points;
    const SearchExtent extent = trial % 2 == 0 ? SearchExtent{0.5, 0.5, 0.15} : SearchExtent{4, 4, 0.4};
    TPose2D predicted = real.nodes[node].local_T_robot - placed.local_T_map;
    predicted.x += share(random) * extent.x_m;
    predicted.y += share(random) * extent.y_m;
    predicted.phi += share(random) * extent.theta_rad;
    const SearchLattice lattice(std::as_const(*placed.map).scores(), scan, predicted,
                                make_search_window(extent, 0.05, scan.farthest_m));
    const SearchOutcome exact = branch_and_bound_search(lattice, 0);
    const FoundPeaks peaks = memetic_search(lattice, request_of(static_cast<std::uint64_t>(trial)), {});
    ++cases;
    if (peaks.best->sum == exact.best->sum) ++same_sum;
    evaluations += peaks.evaluations;
    const SearchWindow& window = lattice.window();
    poses += std::int64_t{2 * window.n_x + 1} * (2 * window.n_y + 1) * (2 * window.n_theta + 1);
  }
  EXPECT_GE(same_sum, cases * 9 / 10);
  EXPECT_LT(evaluations, poses / 5);
}

TEST(MemeticSearch, equal_seeds_give_equal_results_on_any_thread) {
  const Room room;
  const FoundPeaks expected = memetic_search(room.lattice, request_of(3), {});
  std::vector<FoundPeaks> peaks(4);
  std::vector<std::thread> threads;
  for (FoundPeaks& one : peaks)
    threads.emplace_back([&one] {
      const Room own;  // lattices are not shared between threads
      one = memetic_search(own.lattice, request_of(3), {});
    });
  for (std::thread& thread : threads) thread.join();
  for (const FoundPeaks& one : peaks) {
    EXPECT_TRUE(same(one.best, expected.best));
    EXPECT_EQ(one.evaluations, expected.evaluations);
  }
}

TEST(MemeticSearch, the_second_peak_is_distinct_from_the_first) {
  const Room room;
  PeakRequest request = request_of(4);
  request.next = PeakRequest::Next{10, 8, 0.3};
  const FoundPeaks peaks = memetic_search(room.lattice, request, {});
  ASSERT_TRUE(peaks.best && peaks.next);
  const ExcludedRegion around = {peaks.best->pose, 10, 8};
  EXPECT_FALSE(around.contains(peaks.next->pose));
  EXPECT_EQ(peaks.next->sum, slow_sum(room.lattice, peaks.next->pose));
  EXPECT_GE(peaks.next->sum, 0.3 * peaks.best->sum);
  EXPECT_LE(peaks.next->sum, peaks.best->sum);
}

// With two equal rooms, both peaks survive selection.
TEST(MemeticSearch, finds_two_places_that_match_equally) {
  SimulatedWalls walls = furnished_room();
  const std::vector<SimulatedWalls::Wall> one_room = walls.walls;
  const auto box = walls.bounding_box();
  const double apart_m = box.x_max - box.x_min + 1;
  for (const auto& wall : one_room) walls.add_wall(wall.x0 + apart_m, wall.y0, wall.x1 + apart_m, wall.y1);
  const ScoreGrid grid = grid_of(walls);
  std::mt19937_64 random(113);
  const ScanPoints scan = scan_of(furnished_room(), {4, 3, 0.5}, 180, 0.01, random);
  const SearchLattice lattice(grid, scan, {4 + apart_m / 2, 3.2, 0.45},
                              make_search_window({8, 3, 0.2}, 0.05, scan.farthest_m));
  PeakRequest request = request_of(5);
  request.next = PeakRequest::Next{10, 8, 0.6};
  const FoundPeaks peaks = memetic_search(lattice, request, {});
  ASSERT_TRUE(peaks.best && peaks.next);
  EXPECT_NEAR(std::abs(peaks.best->pose.x - peaks.next->pose.x) * 0.05, apart_m, 0.2);
  EXPECT_GT(peaks.next->sum, 0.9 * peaks.best->sum);
}

// Selection keeps one individual in each neighbourhood. Otherwise a population of two would contain only
// neighbours of the first peak.
TEST(MemeticSearch, a_small_population_does_not_crowd_in_one_place) {
  SimulatedWalls walls = furnished_room();
  const std::vector<SimulatedWalls::Wall> one_room = walls.walls;
  for (const auto& wall : one_room) walls.add_wall(wall.x0 + 10, wall.y0, wall.x1 + 10, wall.y1);
  const ScoreGrid grid = grid_of(walls);
  std::mt19937_64 random(115);
  const ScanPoints scan = scan_of(furnished_room(), {4, 3, 0.5}, 180, 0.01, random);
  const SearchLattice lattice(grid, scan, {9, 3.2, 0.45},
                              make_search_window({8, 3, 0.2}, 0.05, scan.farthest_m));
  MemeticGeneticOptions options;
  options.population = options.elite = 2;
  options.children = 2;
  int both = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    PeakRequest request = request_of(seed);
    request.next = PeakRequest::Next{60, 1000, 0.8};
    if (memetic_search(lattice, request, options).next) ++both;
  }
  EXPECT_GE(both, 18);
}

TEST(MemeticSearch, finds_nothing_below_the_smallest_sum) {
  const Room room;
  EXPECT_FALSE(memetic_search(room.lattice, request_of(6, room.lattice.goal_max()), {}).best);
}

TEST(MemeticSearch, needs_the_pyramid_for_more_than_one_block) {
  std::mt19937_64 random(114);
  const ScoreGrid grid(0, 0, 0.05, 60, 60);
  const ScanPoints scan = random_points(random, 5, 1.0);
  const SearchLattice wide(grid, scan, {0, 0, 0}, window_of_steps(20, 20, 2, 0.05));
  EXPECT_THROW(memetic_search(wide, request_of(7), {}), std::invalid_argument);
  const SearchLattice narrow(grid, scan, {0, 0, 0}, window_of_steps(5, 5, 2, 0.05));
  EXPECT_NO_THROW(memetic_search(narrow, request_of(7), {}));
}

}  // namespace
}  // namespace psi_slam
