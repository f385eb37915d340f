// SPDX-License-Identifier: BSD-3-Clause
// Tests the verdict about the map at the end of a run of psi-slam.
#include <gmock/gmock.h>

#include <atomic>
#include <nlohmann/json.hpp>

#include "app_run.h"
#include "psi_slam/mapping_session.h"
#include "session/settings.h"
#include "simulated_run.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;
using Json = nlohmann::json;

constexpr std::size_t kSlip = 645;  // scan in the second round at which the wheels slip

void blind_laser(std::vector<float>& ranges_m, std::size_t scan) {
  constexpr float kNoReturn_m = 500;
  if (scan + 6 > kSlip && scan < kSlip + 6) std::fill(ranges_m.begin(), ranges_m.end(), kNoReturn_m);
}

class VerdictApp : public testing::Test {
 protected:
  /// Maps a run and returns the verdict of summary.json.
  Json verdict_of(const SimulatedRun& run, const std::vector<std::string>& settings = {}) {
    write_file(log_, carmen_log(run));
    std::vector<std::string> words = settings;
    words.push_back(log_.string());
    return verdict_of(std::move(words));
  }
  Json verdict_of(std::vector<std::string> words) {
    words.insert(words.end(), {"-o", (folder_.path() / "out").string(), "--force"});
    app_ = run_app(words);
    return Json::parse(bytes_of(folder_.path() / "out" / "summary.json"))["verdict"];
  }

  /// Records a run that is mapped without loops between places less than 1 km of travel apart.
  std::string recorded(const SimulatedRun& run) {
    write_file(log_, carmen_log(run));
    BoundSettings bound;
    bound.table.set_any("loop_closure.min_travel_m", "1000", "test");
    MappingSession session(log_, bound.settings);
    session.run(std::atomic<bool>(false));
    session.save(folder_.path() / "my.session");
    return (folder_.path() / "my.session").string();
  }

  std::string report() const { return bytes_of(folder_.path() / "out" / "report.html"); }

  TemporaryFolder folder_;
  std::filesystem::path log_ = folder_.path() / "room.log";
  AppRun app_;
};

TEST_F(VerdictApp, finds_a_right_map_good) {
  const Json verdict = verdict_of(round_trips(2));
  EXPECT_EQ(app_.code, 0);
  EXPECT_EQ(verdict["state"], "good") << verdict.dump(1);
  EXPECT_TRUE(verdict["hot_spots"].empty());
  EXPECT_GT(verdict["checked_share"], 0.5);
  EXPECT_THAT(app_.out, HasSubstr("Verdict: the map is good"));
  EXPECT_THAT(app_.err, Not(HasSubstr("suspect")));
  EXPECT_THAT(report(), HasSubstr("<h2>Verdict<small>good</small>"));
  EXPECT_THAT(report(), Not(HasSubstr("id=\"show-hot-spots\"")));
}

/// Two rounds, in the second of which the wheels slip while the laser is blind.
SimulatedRun slipping_run() {
  SimulatedRun run = round_trips(2);
  const mrpt::math::TPose2D before = run.odometry[kSlip - 1];
  const mrpt::math::TPose2D jumped = before + mrpt::math::TPose2D(0.7, 0.4, 0.15);
  for (std::size_t i = kSlip; i < run.odometry.size(); ++i)
    run.odometry[i] = jumped + (run.odometry[i] - before);
  run.put_into = blind_laser;
  return run;
}

TEST_F(VerdictApp, points_at_the_place_where_the_wheels_slipped) {
  const Json verdict = verdict_of(slipping_run(), {"--set", "loop_closure.enabled=false"});
  EXPECT_EQ(app_.code, 0);
  EXPECT_NE(verdict["state"], "good");
  ASSERT_FALSE(verdict["hot_spots"].empty());
  const Json& suspect = verdict["hot_spots"][0]["suspect"];
  EXPECT_LE(suspect["first_scan"], kSlip);
  EXPECT_GE(suspect["last_scan"], kSlip - 6);
  EXPECT_LT(suspect["last_scan"].get<int>() - suspect["first_scan"].get<int>(), 60);
  const std::string& told = verdict["state"] == "broken" ? app_.err : app_.out;
  EXPECT_THAT(told, HasSubstr(verdict["sentence"].get<std::string>() + ". Try: "));
  EXPECT_THAT(report(), HasSubstr("id=\"show-hot-spots\""));
  EXPECT_THAT(report(), HasSubstr("<circle "));
}

TEST_F(VerdictApp, advises_edits_that_mend_the_map) {
  const std::filesystem::path edits = folder_.path() / "my.edits";
  write_file(edits, "");
  const std::vector<std::string> words{"--resume", recorded(slipping_run()), "--edits", edits.string()};
  const auto add_advised_line = [&](const Json& verdict) {
    ASSERT_FALSE(verdict["hot_spots"].empty());
    const Json& spot = verdict["hot_spots"][0];
    ASSERT_TRUE(spot["edit"].is_string()) << spot.dump(1);
    const auto line = spot["edit"].get<std::string>();
    EXPECT_THAT(app_.out + app_.err, HasSubstr("make the edit \"" + line + "\""));
    write_file(edits, bytes_of(edits) + line + '\n');
  };
  const Json first = verdict_of(words);
  EXPECT_EQ(first["state"], "broken");
  add_advised_line(first);
  EXPECT_THAT(bytes_of(edits), testing::StartsWith("match scan="));
  EXPECT_THAT(app_.err, HasSubstr("the map may be wrong there"));
  // The odometry of the slip contradicts a single match, so the next advice is to force it.
  add_advised_line(verdict_of(words));
  EXPECT_THAT(bytes_of(edits), HasSubstr("\nforce scan="));
  const Json mended = verdict_of(words);
  EXPECT_EQ(mended["state"], "good") << mended.dump(1);
  EXPECT_THAT(app_.err, Not(HasSubstr("an edit was not made")));
  EXPECT_THAT(app_.err, Not(HasSubstr("may be wrong")));
  EXPECT_THAT(app_.err, HasSubstr("the scans before and after fit each other"));
}

}  // namespace
}  // namespace psi_slam
