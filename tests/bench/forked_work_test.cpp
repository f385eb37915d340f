// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/forked_work.h"

#include <gmock/gmock.h>

#include <csignal>
#include <stdexcept>
#include <vector>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Report = std::function<void(const std::string&)>;

TEST(ForkedWork, returns_reports_and_result) {
  std::vector<std::string> reports;
  const ForkedResult result = run_forked(
      [](const Report& report) {
        report("one");
        report("");
        return std::string(100'000, 'x');
      },
      [&](const std::string& report) { reports.push_back(report); });
  EXPECT_EQ(result.text, std::string(100'000, 'x'));
  EXPECT_THAT(reports, testing::ElementsAre("one", ""));
}

TEST(ForkedWork, measures_the_memory_of_each_child) {
  const auto holding = [](std::size_t bytes) {
    return run_forked(
               [bytes](const Report&) {
                 const std::vector<char> held(bytes, 1);
                 return std::string(1, held.back());
               },
               [](const std::string&) {})
        .peak_memory_mib;
  };
  const double much_mib = holding(200'000'000);
  EXPECT_GT(much_mib, 190);
  EXPECT_LT(holding(1000), much_mib - 150);
}

TEST(ForkedWork, rethrows_errors_of_the_child) {
  const auto ignore = [](const std::string&) {};
  EXPECT_THROW(run_forked([](const Report&) -> std::string { throw UserError("mistaken"); }, ignore),
               UserError);
  EXPECT_THROW(run_forked([](const Report&) -> std::string { throw std::runtime_error("failed"); }, ignore),
               SystemFailure);
  EXPECT_THROW(run_forked(
                   [](const Report&) -> std::string {
                     std::raise(SIGKILL);
                     return {};
                   },
                   ignore),
               SystemFailure);
}

}  // namespace
}  // namespace psi_slam
