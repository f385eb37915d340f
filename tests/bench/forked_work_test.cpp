// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/forked_work.h"

#include <gmock/gmock.h>

#include <csignal>
#include <stdexcept>
#include <vector>

#include "map/exports/run_summary.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

TEST(ForkedWork, returns_reports_and_result) {
  std::vector<std::string> reports;
  const std::string result = run_forked(
      [](const TextObserver& report) {
        report("one");
        report("");
        return std::string(100'000, 'x');
      },
      [&](const std::string& report) { reports.push_back(report); });
  EXPECT_EQ(result, std::string(100'000, 'x'));
  EXPECT_THAT(reports, testing::ElementsAre("one", ""));
}

TEST(ForkedWork, a_child_measures_its_own_memory) {
  const auto holding = [](std::size_t bytes) {
    return std::stod(run_forked(
        [bytes](const TextObserver&) {
          const std::vector<char> held(bytes, 1);
          return std::to_string(peak_memory_mib() + 0 * held.back());
        },
        [](const std::string&) {}));
  };
  const double much_mib = holding(200'000'000);
  EXPECT_GT(much_mib, 190);
  EXPECT_LT(holding(1000), much_mib - 150);
}

TEST(ForkedWork, rethrows_errors_of_the_child) {
  const auto ignore = [](const std::string&) {};
  EXPECT_THROW(run_forked([](const TextObserver&) -> std::string { throw UserError("mistaken"); }, ignore),
               UserError);
  EXPECT_THROW(
      run_forked([](const TextObserver&) -> std::string { throw std::runtime_error("failed"); }, ignore),
      SystemFailure);
  EXPECT_THROW(run_forked(
                   [](const TextObserver&) -> std::string {
                     std::raise(SIGKILL);
                     return {};
                   },
                   ignore),
               SystemFailure);
}

}  // namespace
}  // namespace psi_slam
