// SPDX-License-Identifier: BSD-3-Clause
#include "logs/doctor/jackknife.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <random>
#include <vector>

namespace psi_slam {
namespace {

using Value = Eigen::Matrix<double, 1, 1>;

/// Mean of the values but [first, last).
Value mean_without(const std::vector<double>& values, std::size_t first, std::size_t last) {
  double sum = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
    if (i < first || i >= last) sum += values[i];
  return Value(sum / static_cast<double>(values.size() - (last - first)));
}

double deviation_of_mean(const std::vector<double>& values) {
  return std::sqrt(jackknife_covariance<1>(values.size(), [&](std::size_t first, std::size_t last) {
    return mean_without(values, first, last);
  })(0, 0));
}

TEST(Jackknife, allows_for_errors_that_neighbours_share) {
  constexpr std::size_t kValues = 1000;
  constexpr unsigned kTrials = 200;
  double squares = 0;
  for (unsigned seed = 1; seed <= kTrials; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> error;
    std::vector<double> values;
    double shared = 0;
    for (std::size_t i = 0; i < kValues; ++i) {
      if (i % 10 == 0) shared = error(random);
      values.push_back(shared + 0.5 * error(random));
    }
    squares += std::pow(mean_without(values, 0, 0)[0] / deviation_of_mean(values), 2);
  }
  EXPECT_NEAR(std::sqrt(squares / kTrials), 1, 0.2);
}

TEST(Jackknife, is_large_if_one_part_decides) {
  std::vector<double> values(1000, 0);
  for (std::size_t i = 500; i < 550; ++i) values[i] = 20;  // the mean is 1
  EXPECT_NEAR(deviation_of_mean(values), 1, 0.1);
}

}  // namespace
}  // namespace psi_slam
