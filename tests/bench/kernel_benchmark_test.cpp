// SPDX-License-Identifier: BSD-3-Clause
#include "kernels/kernel_benchmark.h"

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>
#include <set>

#include "command_fixture.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

TEST(KernelBenchmark, measures_each_kernel) {
  const KernelBenchmark benchmark = run_kernel_benchmark({1});
  std::set<std::string> kernels;
  std::set<std::string> of_baseline;
  std::set<std::string> of_avx2;
  std::set<std::string> of_avx512;
  for (const KernelRow& row : benchmark.rows) {
    kernels.insert(row.kernel);
    (row.set == InstructionSet::kBaseline ? of_baseline
     : row.set == InstructionSet::kAvx2   ? of_avx2
                                          : of_avx512)
        .insert(row.kernel);
    EXPECT_GT(row.bytes, 160) << row.kernel;
    EXPECT_GT(row.call_ns, 0) << row.kernel;
    EXPECT_GT(row.reading_bytes_per_ns, 0) << row.kernel;
    EXPECT_GT(row.share_of_limit(), 0) << row.kernel;
  }
  EXPECT_EQ(kernels.size(), 7U);
  EXPECT_EQ(of_baseline, kernels);
  EXPECT_EQ(of_avx2.count("sum scores of 16 x 8 poses") != 0, can_use(InstructionSet::kAvx2));
  EXPECT_EQ(of_avx512.count("compare points with the grid") != 0, can_use(InstructionSet::kAvx512));
}

TEST(KernelBenchmark, measures_the_sum_kernel_in_use) {
  EXPECT_GT(sum_kernel_scores_per_ns(1), 0);
}

TEST(KernelReport, shows_rates_and_shares_of_the_limit) {
  KernelBenchmark benchmark;
  benchmark.rows = {{"place points", InstructionSet::kAvx2, 2560, 64, 100}};
  const BenchReport report = kernel_report(benchmark, {}, "a machine");
  EXPECT_EQ(report.page, "kernels.md");
  EXPECT_THAT(report.markdown, HasSubstr("| place points | AVX2 | 2560 | 64 | 40.0 | 100 | 40 % |"));
  const auto json = nlohmann::json::parse(report.json);
  EXPECT_EQ(json["schema"], "psi-slam-kernels");
  EXPECT_EQ(json["rows"][0]["share_of_limit"], 0.4);
  EXPECT_THAT(report.csv, HasSubstr("bytes_per_ns"));
}

using KernelsCommand = BenchCommand;

TEST_F(KernelsCommand, needs_no_logs) {
  EXPECT_EQ(run_program({"kernels", "--repeats", "1"}), 0) << err_.str();
  EXPECT_THAT(out_.str(), HasSubstr("| sum scores of 16 x 8 poses | baseline |"));
}

TEST_F(KernelsCommand, wrong_usage_gives_one_sentence_and_exit_code_2) {
  EXPECT_THAT(refusal_of({"kernels", "--repeats", "0"}), HasSubstr("--repeats"));
}

}  // namespace
}  // namespace psi_slam
