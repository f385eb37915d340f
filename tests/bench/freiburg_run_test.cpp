// SPDX-License-Identifier: BSD-3-Clause
#include "freiburg/freiburg_benchmark.h"

#include <gmock/gmock.h>

#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

class FreiburgRuns : public testing::Test {
 protected:
  FreiburgRuns() { write_room_benchmark(folder_.path(), folder_.path()); }

  FreiburgRun run(const std::string& matcher, std::uint64_t seed = 1) const {
    return {folder_.path() / "room.log",
            folder_.path() / "room.ini",
            folder_.path() / "room.relations",
            matcher,
            seed,
            1};
  }

  TemporaryFolder folder_;
};

TEST_F(FreiburgRuns, gives_the_figures_of_the_whole_log) {
  const FreiburgFigures figures = map_and_evaluate(run("adaptive"));
  EXPECT_EQ(figures.scans, 190U);
  EXPECT_NEAR(figures.duration_s, 189 * 0.2, 1e-9);
  EXPECT_EQ(figures.relations_used, 17U);
  EXPECT_EQ(figures.relations_skipped, 0U);
  EXPECT_GT(figures.loops_accepted, 0U);
  EXPECT_LE(figures.loops_judged, figures.loops_accepted);
  EXPECT_LT(figures.errors.translation_abs_m.mean, 0.1);
  EXPECT_GT(figures.errors.translation_abs_m.mean, 0);
  const MeanAndStd& absolute = figures.errors.translation_abs_m;
  EXPECT_NEAR(figures.errors.translation_sq_m2.mean,
              absolute.mean * absolute.mean + absolute.std * absolute.std, 1e-12)
      << "the mean of squares is the squared mean plus the variance";
}

TEST_F(FreiburgRuns, judges_the_loops_by_the_relations) {
  const FreiburgFigures no_passes = map_and_evaluate(run("csm"));
  EXPECT_FALSE(no_passes.loop_recall) << "no relation connects two passes";
  write_room_passes(folder_.path());
  const FreiburgFigures figures = map_and_evaluate(run("csm"));
  EXPECT_GT(figures.loops_judged, 10U);
  EXPECT_EQ(figures.loops_false, 0U);
  EXPECT_GT(figures.loop_recall.value(), 0.8);
  write_room_passes(folder_.path(), 1);
  const FreiburgFigures moved = map_and_evaluate(run("csm"));
  EXPECT_EQ(moved.loops_judged, figures.loops_judged);
  EXPECT_EQ(moved.loops_false, figures.loops_judged) << "the same map with relations 1 m off";
  EXPECT_EQ(moved.loop_recall, figures.loop_recall);
}

TEST_F(FreiburgRuns, csm_draws_no_random_numbers) {
  EXPECT_FALSE(draws_random_numbers("csm"));
  EXPECT_EQ(figures_json(map_and_evaluate(run("csm", 1))), figures_json(map_and_evaluate(run("csm", 2))));
}

TEST_F(FreiburgRuns, each_matcher_and_seed_has_its_own_settings) {
  std::vector<std::string> texts;
  for (const std::string& matcher : freiburg_matchers())
    texts.push_back(settings_text(settings_of(run(matcher))));
  texts.push_back(settings_text(settings_of(run("ga", 2))));
  for (std::size_t i = 0; i < texts.size(); ++i)
    for (std::size_t k = 0; k < i; ++k) EXPECT_NE(texts[i], texts[k]);
  const std::string paper = settings_text(settings_of(run("adaptive_paper")));
  EXPECT_THAT(paper, HasSubstr("loop_closure.matcher = adaptive\n"));
  EXPECT_THAT(paper, HasSubstr("genetic.variant = paper\n"));
  const PsiOptions psi = settings_of(run("adaptive_paper")).mapper.back_end.psi;
  EXPECT_GE(psi.psi_1, 0)
      << "the paper searches exhaustively where loops are rare, and Psi is 0 without loops";
  EXPECT_EQ(matcher_kind({}, psi, 0), MatcherKind::kCsm);
  EXPECT_EQ(matcher_kind({}, psi, psi.psi_2), MatcherKind::kGa);
  EXPECT_GT(psi.max_poses, 1e15) << "the paper chooses by Psi alone";
  EXPECT_THAT(settings_text(settings_of(run("adaptive"))), HasSubstr("genetic.variant = memetic\n"));
}

TEST_F(FreiburgRuns, figures_are_read_back_exactly) {
  FreiburgFigures figures = map_and_evaluate(run("csm"));
  figures.wall_s = 1.0 / 3;
  figures.cpu_s = 2.0 / 3;
  figures.peak_memory_mib = 1.1;
  EXPECT_FALSE(read_figures(figures_json(figures)).value().loop_recall);
  figures.loops_judged = 30;
  figures.loops_false = 2;
  figures.loop_recall = 5.0 / 7;
  const auto again = read_figures(figures_json(figures));
  ASSERT_TRUE(again);
  EXPECT_EQ(figures_json(*again), figures_json(figures));
  EXPECT_EQ(again->wall_s, figures.wall_s);
  EXPECT_EQ(again->loops_judged, 30U);
  EXPECT_EQ(again->loops_false, 2U);
  EXPECT_EQ(again->loop_recall, 5.0 / 7);
  EXPECT_NEAR(again->real_time_factor(), 3 * 189 * 0.2, 1e-9);
  EXPECT_FALSE(read_figures("{}"));
  EXPECT_FALSE(read_figures("no JSON"));
}

TEST_F(FreiburgRuns, a_log_that_ends_early_has_no_figures) {
  std::vector<std::string> lines = room_log_lines(190);
  std::string bytes;
  for (const std::string& line : lines) bytes += line + '\n';
  write_gzipped(folder_.path() / "room.log.gz", bytes);
  const std::string whole = read_file(folder_.path() / "room.log.gz");
  write_file(folder_.path() / "room.log.gz", whole.substr(0, whole.size() / 2));
  FreiburgRun broken = run("csm");
  broken.log = folder_.path() / "room.log.gz";
  EXPECT_THAT(sentence_of([&] { map_and_evaluate(broken); }), HasSubstr("room.log.gz"));
}

}  // namespace
}  // namespace psi_slam
