// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/body_masked_source.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <ostream>
#include <sstream>
#include <string>
#include <vector>

#include "base/text_parts.h"
#include "log_files.h"
#include "logs/frames/log_reader.h"
#include "robot_body.h"
#include "shared_logs.h"
#include "simulated_run.h"
#include "temporary_folder.h"
#include "two_lasers.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

LogOptions unmasked() {
  LogOptions options;
  options.mask_own_body = false;
  return options;
}

/// Number of readings that are invalid in `masked` and valid in `recorded`. Expects that all else is equal.
std::size_t masked_readings(const std::vector<Frame>& recorded, const std::vector<Frame>& masked) {
  std::size_t count = 0;
  EXPECT_EQ(recorded.size(), masked.size());
  for (std::size_t i = 0; i < std::min(recorded.size(), masked.size()); ++i) {
    EXPECT_EQ(recorded[i].index, masked[i].index);
    EXPECT_EQ(recorded[i].time_us, masked[i].time_us);
    const std::vector<float>& before_m = recorded[i].scan.ranges_m;
    const std::vector<float>& after_m = masked[i].scan.ranges_m;
    EXPECT_EQ(before_m.size(), after_m.size());
    for (std::size_t beam = 0; beam < after_m.size(); ++beam) {
      if (std::isnan(after_m[beam]))
        count += std::isnan(before_m[beam]) ? 0 : 1;
      else
        EXPECT_EQ(before_m[beam], after_m[beam]);
    }
  }
  return count;
}

class BodyMaskedSourceTest : public testing::Test {
 protected:
  void SetUp() override {
    run_.put_into = RobotBody::put_into;
    write_file(log_, carmen_log(run_));
  }

  SimulatedRun run_ = round_trips(2);
  TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "log.clf";
};

TEST_F(BodyMaskedSourceTest, masks_the_body_from_the_first_scan) {
  const std::vector<Frame> masked = frames_of(log_);
  EXPECT_TRUE(std::isnan(masked.front().scan.ranges_m[RobotBody::first_mast_beam(180)]));
  const std::size_t count = masked_readings(frames_of(log_, unmasked()), masked);
  EXPECT_NEAR(static_cast<double>(count) / static_cast<double>(masked.size()), 8 + 2 * 0.5, 0.1);
}

TEST_F(BodyMaskedSourceTest, reading_ahead_does_not_count_as_progress) {
  const auto log = open_log(log_);
  const auto plain = open_log(log_, unmasked());
  while (log->next()) {
    plain->next();
    EXPECT_EQ(log->progress(), plain->progress());
  }
  EXPECT_EQ(log->progress(), 1);
}

TEST_F(BodyMaskedSourceTest, says_what_is_masked) {
  const auto log = open_log(log_);
  EXPECT_THAT(log->assumptions(), IsEmpty());
  ASSERT_TRUE(log->next());
  EXPECT_THAT(
      log->assumptions(),
      ElementsAre("the laser at x 0.00 m, y 0.00 m sees the robot itself in 10.0 degrees (8 beams from "
                  "-45.0 to -38.0 degrees at 0.35 m, 2 beams from 45.0 to 46.0 degrees at 0.60 m), so "
                  "these readings are ignored. Keep them with log.mask_own_body=off"));
  const auto unmasked_log = open_log(log_, unmasked());
  unmasked_log->next();
  EXPECT_THAT(unmasked_log->assumptions(), IsEmpty());
}

TEST_F(BodyMaskedSourceTest, masks_thinned_and_whole_logs_alike) {
  LogOptions options;
  options.every_nth_scan = 50;
  const std::vector<Frame> some = frames_of(log_, options);
  const std::vector<Frame> all = frames_of(log_);
  for (const Frame& frame : some) {
    const std::vector<float>& ranges_m = all[50 * frame.index].scan.ranges_m;
    for (std::size_t beam = 0; beam < ranges_m.size(); ++beam)
      EXPECT_EQ(std::isnan(frame.scan.ranges_m[beam]), std::isnan(ranges_m[beam]));
  }
}

TEST_F(BodyMaskedSourceTest, masks_up_to_the_damage_of_a_log) {
  const std::string whole = read_file(log_);
  write_file(log_, whole.substr(0, whole.size() - 100));
  const auto log = open_log(log_);
  std::size_t scans = 0;
  EXPECT_THAT(sentence_of([&] {
                while (const auto frame = log->next()) {
                  EXPECT_TRUE(std::isnan(frame->scan.ranges_m[RobotBody::first_mast_beam(180)]));
                  ++scans;
                }
              }),
              HasSubstr("the file is cut off in this line"));
  EXPECT_EQ(scans, run_.truth.size() - 1);
}

TEST_F(BodyMaskedSourceTest, looks_only_at_the_first_seconds_of_a_stream) {
  const auto plain = open_log_reader(log_, {});
  BodyMaskedSource brief(open_log_reader(log_, {}), 1.0);
  EXPECT_EQ(masked_readings(all_frames(*plain), all_frames(brief)), 0U) << "the robot has not turned enough";
  EXPECT_THAT(brief.assumptions(), IsEmpty());
  BodyMaskedSource at_length(open_log_reader(log_, {}), 1e9);
  const std::optional<Frame> first = at_length.next();
  ASSERT_TRUE(first);
  EXPECT_TRUE(std::isnan(first->scan.ranges_m[RobotBody::first_mast_beam(180)]));
}

TEST_F(BodyMaskedSourceTest, masks_companions_too) {
  TwoLasers robot;
  robot.scans = 200;  // three turns
  write_carmen_of(log_, robot, true);
  std::istringstream log(read_file(log_));
  std::string text;
  for (std::string line; std::getline(log, line); text += line + '\n') {
    if (!starts_with(line, "RLASER")) continue;
    std::size_t at = 0;
    for (std::size_t field = 0; field < 22; ++field) at = line.find(' ', at) + 1;
    line.replace(at, line.find(' ', at) - at, "0.25");  // beam 20
  }
  write_file(log_, text);
  LogOptions options;
  options.laser = "all";
  const auto source = open_log(log_, options);
  std::size_t companions = 0;
  while (const auto frame = source->next()) {
    EXPECT_FALSE(std::isnan(frame->scan.ranges_m[20]));
    for (const CompanionScan& companion : frame->companions) {
      EXPECT_TRUE(std::isnan(companion.scan.ranges_m[20]));
      ++companions;
    }
  }
  EXPECT_GT(companions, 150U);
  EXPECT_THAT(
      source->assumptions(),
      ElementsAre(HasSubstr("the laser at x -0.40 m, y -0.10 m sees the robot itself in 1.0 degrees")));
}

// ---- Real logs ----

struct RealLog {
  const char* file;
  /// Parts of the robot itself in text_of() form, for each laser by number. Empty: no laser sees the robot.
  std::vector<std::string> body;

  friend std::ostream& operator<<(std::ostream& out, const RealLog& log) { return out << log.file; }
};

class RealLogBody : public testing::TestWithParam<RealLog> {};

TEST_P(RealLogBody, is_only_what_the_robot_is) {
  const auto path = shared_file(GetParam().file);
  if (!path) GTEST_SKIP() << kNeedsData;
  const OwnBodyMask mask = find_own_body(*open_log_reader(*path, {}));
  std::vector<std::string> body;
  for (const BodySector& sector : mask.sectors())
    body.push_back(std::to_string(sector.laser) + ": " + text_of({sector}));
  EXPECT_EQ(body, GetParam().body);
}

std::string name_of(const testing::TestParamInfo<RealLog>& info) {
  std::string name = info.param.file;
  for (char& c : name)
    if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
  return name;
}

INSTANTIATE_TEST_SUITE_P(
    Each, RealLogBody,
    testing::Values(RealLog{"aces.clf.gz", {}}, RealLog{"intel.clf.gz", {}},
                    RealLog{"mit-killian.clf.gz", {}}, RealLog{"mit-csail.clf.gz", {}},
                    RealLog{"fr079.clf.gz", {}}, RealLog{"sparse/fhw.clf.gz", {}},
                    RealLog{"sparse/acapulco.clf.gz", {}}, RealLog{"sparse/freiburg-campus.clf.gz", {}},
                    RealLog{"bags/ccny_urg_demo.bag", {}}, RealLog{"bags/guardian_controller_2.bag", {}},
                    RealLog{"bags/jan17_expt04.bag", {}}, RealLog{"bags/jan17_expt10.bag", {}},
                    RealLog{"bags/jarvis_circular_path_fast.bag", {}}),
    name_of);

TEST(RealLogWithBody, is_masked_to_the_readings_of_the_clean_log) {
  const auto path = shared_file("fr079.clf.gz");
  if (!path) GTEST_SKIP() << kNeedsData;
  LogOptions options = unmasked();
  options.max_range_m = 50;
  const auto open = [&]() -> std::unique_ptr<FrameSource> {
    return std::make_unique<SeesRobotBody>(open_log_reader(*path, options));
  };
  const std::vector<Frame> clean = frames_of(*path, options);
  const auto recorded_log = open();
  const std::vector<Frame> recorded = all_frames(*recorded_log);
  BodyMaskedSource source(open());
  const std::vector<Frame> masked = all_frames(source);
  std::size_t body = 0;
  std::size_t body_kept = 0;
  std::size_t others_lost = 0;
  ASSERT_EQ(masked.size(), clean.size());
  for (std::size_t i = 0; i < clean.size(); ++i) {
    for (std::size_t beam = 0; beam < clean[i].scan.ranges_m.size(); ++beam) {
      const bool is_body = recorded[i].scan.ranges_m[beam] != clean[i].scan.ranges_m[beam] &&
                           !std::isnan(recorded[i].scan.ranges_m[beam]);
      const bool is_masked = std::isnan(masked[i].scan.ranges_m[beam]);
      if (is_body) ++body;
      if (is_body && !is_masked) ++body_kept;
      if (!is_body && is_masked && !std::isnan(clean[i].scan.ranges_m[beam])) ++others_lost;
    }
  }
  EXPECT_GT(body, 8 * clean.size());
  EXPECT_EQ(body_kept, 0U);
  EXPECT_LT(others_lost, body / 50);
}

}  // namespace
}  // namespace psi_slam
