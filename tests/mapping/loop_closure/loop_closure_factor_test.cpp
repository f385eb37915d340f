// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_closure_factor.h"

#include <gtest/gtest.h>

namespace psi_slam {
namespace {

PsiOptions options_of(int window_frames, double eta_max) {
  PsiOptions options;
  options.window_frames = window_frames;
  options.eta_max = eta_max;
  return options;
}

TEST(LoopClosureFactor, without_history_no_loop_is_expected) {
  LoopClosureFactor factor(options_of(3, 20));
  factor.move(0, {0, 0});
  factor.move(2, {2, 0});
  EXPECT_EQ(factor.value().mean_loops, 0);
  EXPECT_EQ(factor.value().eta, 1);
  EXPECT_EQ(factor.value().psi, 0);
}

TEST(LoopClosureFactor, averages_over_the_searches_available) {
  LoopClosureFactor factor(options_of(4, 20));
  factor.move(0, {1, 1});
  factor.move(6, {1, 4});  // eta = 6 / 3
  factor.add_search(3);
  EXPECT_EQ(factor.value().mean_loops, 3);
  EXPECT_EQ(factor.value().psi, 6);
  factor.add_search(0);
  EXPECT_EQ(factor.value().mean_loops, 1.5);
  EXPECT_EQ(factor.value().psi, 3);
}

TEST(LoopClosureFactor, only_the_last_searches_count) {
  LoopClosureFactor factor(options_of(3, 20));
  factor.move(0, {0, 0});
  factor.move(5, {3, 4});  // eta = 1
  for (const int loops : {9, 1, 2, 6}) factor.add_search(loops);
  EXPECT_EQ(factor.value().mean_loops, 3) << "(1 + 2 + 6) / 3";
  EXPECT_EQ(factor.value().psi, 3);
  factor.add_search(1);
  EXPECT_EQ(factor.value().mean_loops, 3) << "(2 + 6 + 1) / 3";
  for (int i = 0; i < 3; ++i) factor.add_search(0);
  EXPECT_EQ(factor.value().psi, 0);
}

TEST(LoopClosureFactor, counts_the_path_of_every_scan) {
  LoopClosureFactor factor(options_of(2, 20));
  factor.move(0, {0, 0});
  factor.add_search(1);
  for (const double x : {1.0, 2.0, 3.0, 2.0}) factor.move(1.5, {x, 0});
  factor.add_search(2);
  EXPECT_EQ(factor.value().eta, 3) << "6 m of path, 2 m from the start";
  EXPECT_EQ(factor.value().psi, 4.5);
}

TEST(LoopClosureFactor, back_at_its_start_eta_is_at_its_bound) {
  LoopClosureFactor factor(options_of(2, 20));
  factor.move(0, {5, 5});
  factor.add_search(2);
  factor.move(10, {5, 15});
  EXPECT_EQ(factor.value().eta, 1);
  factor.move(10, {5, 5});
  EXPECT_EQ(factor.value().eta, 20) << "20 m of path, 0 m from the start";
  EXPECT_EQ(factor.value().psi, 40);
  factor.move(0.5, {5, 5.5});
  EXPECT_EQ(factor.value().eta, 20) << "20.5 m / 0.5 m = 41";
  factor.move(0.5, {5, 6.05});
  EXPECT_EQ(factor.value().eta, 20) << "21 m / 1.05 m is just the bound";
  factor.move(0.5, {5, 7});
  EXPECT_EQ(factor.value().eta, 10.75);
}

TEST(LoopClosureFactor, at_the_very_start_eta_is_at_its_bound_and_psi_is_zero) {
  LoopClosureFactor factor(options_of(2, 7));
  EXPECT_EQ(factor.value().eta, 7) << "before the first scan";
  factor.move(0, {3, -2});
  EXPECT_EQ(factor.value().eta, 7) << "0 m of path, 0 m from the start";
  EXPECT_EQ(factor.value().psi, 0);
}

}  // namespace
}  // namespace psi_slam
