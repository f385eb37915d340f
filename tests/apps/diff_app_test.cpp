// SPDX-License-Identifier: BSD-3-Clause
// Tests whole runs of psi-slam diff.
#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "../session/room_log.h"
#include "app_run.h"
#include "localization/reference_map.h"
#include "map/exports/map_files.h"
#include "map/exports/map_server_pair.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using Json = nlohmann::json;

/// Maps the room once for all tests.
class DiffApp : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    folder_ = std::make_unique<TemporaryFolder>();
    const auto log = write_lines(path("room.log"), room_log_lines(150, 100));
    ASSERT_EQ(run_app({log.string(), "-q", "-o", path("a").string()}).code, 0);
    ASSERT_EQ(run_app({log.string(), "-q", "--seed", "2", "-o", path("b").string()}).code, 0);
  }
  static void TearDownTestSuite() { folder_.reset(); }

  static std::filesystem::path path(const std::string& name) { return folder_->path() / name; }

  static AppRun diff(const std::string& a, const std::string& b, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments{"diff", path(a).string(), path(b).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run_app(arguments);
  }

  static std::unique_ptr<TemporaryFolder> folder_;
};

std::unique_ptr<TemporaryFolder> DiffApp::folder_;

TEST_F(DiffApp, maps_of_one_log_with_two_seeds_do_not_differ) {
  for (const std::string b : {"b", "b/map.yaml", "b/map.gridmap.gz"}) {
    const AppRun run = diff("a", b);
    EXPECT_EQ(run.code, 0) << run.out << run.err;
    EXPECT_THAT(run.out, HasSubstr("No wall has changed"));
  }
  EXPECT_EQ(diff("a", "b", {"--aligned", "-q"}).out, "");
}

TEST_F(DiffApp, a_new_wall_gives_exit_code_1_and_three_files) {
  auto map = read_map_file(path("b/map.yaml"));
  for (double y = -0.5; y < 0.5; y += 0.02) map.setPos(static_cast<float>(-0.4), static_cast<float>(y), 0);
  write_map_server_pair(path("new.yaml"), map);
  const AppRun run = diff("a", "new.yaml", {"-o", path("out").string(), "--json"});
  EXPECT_EQ(run.code, 1) << run.err;
  const Json json = Json::parse(run.out);
  EXPECT_EQ(json["changed"], true);
  EXPECT_EQ(json["appeared"]["walls"], 1);
  EXPECT_EQ(json["vanished"]["walls"], 0);
  EXPECT_NEAR(json["alignment"]["x_m"].get<double>(), 0, 0.03);
  EXPECT_EQ(bytes_of(path("out/diff.json")), run.out);
  EXPECT_THAT(bytes_of(path("out/diff.csv")), HasSubstr("\nappeared,-0.3"));
  EXPECT_THAT(bytes_of(path("out/diff.png")), HasSubstr("PNG"));
  EXPECT_EQ(diff("a", "new.yaml", {"--min-length-m", "1.5"}).code, 0);
  EXPECT_EQ(diff("a", "new.yaml", {"--tolerance-m", "3"}).code, 0);
}

TEST_F(DiffApp, a_system_failure_does_not_look_like_a_change) {
  std::ostringstream out;
  std::ostringstream err;
  out.setstate(std::ios::badbit);  // a full disk behind standard output
  EXPECT_EQ(run_psi_slam_app({"diff", path("a").string(), path("b").string()}, {out, err, false}), 2);
  EXPECT_THAT(err.str(), HasSubstr("cannot write to standard output"));
}

TEST_F(DiffApp, mistakes_give_exit_code_2_and_one_sentence) {
  const auto complaint = [&](const AppRun& run) {
    EXPECT_EQ(run.code, 2) << run.out;
    return run.err;
  };
  EXPECT_THAT(complaint(run_app({"diff", path("a").string()})), HasSubstr("name two maps"));
  for (const std::string none : {"none.yaml", "none/"})
    EXPECT_THAT(complaint(diff("a", none)),
                HasSubstr(none + " does not exist, expected the results folder of a run, map.yaml or"));
  const std::string session = path("room.session").string();
  ASSERT_EQ(
      run_app({path("room.log").string(), "-q", "--save-session", session, "-o", path("c").string()}).code,
      0);
  EXPECT_THAT(
      complaint(diff("room.session", "b")),
      HasSubstr("is a session, expected a map. Map it with psi-slam --resume " + session + " -o DIR"));
  EXPECT_THAT(complaint(diff("a", "room.log")),
              HasSubstr("is not a map: expected map.yaml or map.gridmap.gz"));
  std::filesystem::create_directories(path("empty"));
  EXPECT_THAT(complaint(diff("empty", "b")), HasSubstr("the folder has no map"));
  EXPECT_THAT(complaint(diff("a", "b", {"--tolerance-m", "-1"})), HasSubstr("expected a length in metres"));
  EXPECT_THAT(complaint(diff("a", "b", {"--aligned", "--start", "0,0,0"})), HasSubstr("contradicts"));
  EXPECT_THAT(complaint(diff("a", "b", {"--start", "40,40,45"})), HasSubstr("Correct the pose of --start"));
}

}  // namespace
}  // namespace psi_slam
