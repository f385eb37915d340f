// SPDX-License-Identifier: BSD-3-Clause
#include "session/site_folder.h"

#include <gmock/gmock.h>
#include <mrpt/maps/COccupancyGridMap2D.h>

#include <filesystem>
#include <memory>
#include <string>

#include "map/exports/map_files.h"
#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

class SiteFolderTest : public testing::Test {
 protected:
  /// Puts the map of a room, with or without a wall across it, into the folder of a run.
  void write_map(const fs::path& folder, bool with_wall) const {
    mrpt::maps::COccupancyGridMap2D map;
    map.setSize(0, 8, 0, 6, 0.05F, 0.95F);
    for (int x = 0; x < 160; ++x) map.setCell(x, 0, 0.1F), map.setCell(x, 119, 0.1F);
    for (int y = 0; y < 120; ++y) map.setCell(0, y, 0.1F), map.setCell(159, y, 0.1F);
    if (with_wall)
      for (int y = 40; y < 80; ++y) map.setCell(80, y, 0.1F);
    fs::create_directories(folder);
    write_mrpt_map(folder / "map.gridmap.gz", map);
  }

  SiteRun run(const fs::path& folder) const {
    SiteRun run;
    run.folder = folder.filename().string();
    run.log = "monday.log";
    run.first_time_us = 1'700'000'000'000'000;
    run.path_length_m = 12.5;
    return run;
  }

  const SiteRun& add(bool with_wall) {
    const fs::path folder = SiteFolder(path_).folder_of_next("monday");
    write_map(folder, with_wall);
    site_ = std::make_unique<SiteFolder>(path_);
    return site_->add(run(folder));
  }

  std::string failure() const {
    try {
      SiteFolder site(path_);
      site.newest_map();
      return "";
    } catch (const UserError& error) {
      return error.what();
    }
  }

  TemporaryFolder folder_;
  const fs::path path_ = folder_.path() / "office";
  std::unique_ptr<SiteFolder> site_;
};

TEST_F(SiteFolderTest, begins_with_the_first_run) {
  const SiteFolder site(path_);
  EXPECT_THAT(site.runs(), IsEmpty());
  EXPECT_FALSE(site.newest_map());
  EXPECT_EQ(site.folder_of_next("monday"), path_ / "0001-monday");
  EXPECT_FALSE(fs::exists(path_)) << "reading creates nothing";
  EXPECT_THAT(add(false).changes, IsEmpty());
  EXPECT_EQ(SiteFolder(path_).newest_map(), path_ / "0001-monday" / "map.gridmap.gz");
  EXPECT_EQ(SiteFolder(path_).folder_of_next("TCP port 5000"), path_ / "0002-TCP-port-5000");
}

TEST_F(SiteFolderTest, lists_what_each_run_changed) {
  add(false);
  const SiteRun added = add(true);
  ASSERT_EQ(added.changes.size(), 1U);
  EXPECT_EQ(added.changes[0].kind, WallChange::Kind::kAppeared);
  EXPECT_NEAR(added.changes[0].length_m, 2, 0.1);
  EXPECT_NEAR(added.changes[0].middle().x, 4, 0.1);
  EXPECT_EQ(changes_text(added.changes), "1 wall is new (2.0 m)");
  add(false);
  const SiteFolder site(path_);
  ASSERT_EQ(site.runs().size(), 3U);
  EXPECT_EQ(site.runs()[1].changes.size(), 1U);
  EXPECT_EQ(site.runs()[1].changes[0].from, added.changes[0].from);
  EXPECT_EQ(changes_text(site.runs()[2].changes), "1 wall is gone (2.0 m)");
  EXPECT_EQ(site.runs()[2].first_time_us, 1'700'000'000'000'000);
  EXPECT_EQ(site.runs()[2].log, "monday.log");
  EXPECT_EQ(fs::read_symlink(path_ / "newest"), "0003-monday");
}

TEST_F(SiteFolderTest, goes_back_when_folders_are_deleted) {
  for (int day = 0; day < 3; ++day) add(day == 1);
  fs::remove_all(path_ / "0003-monday");
  EXPECT_EQ(SiteFolder(path_).newest_map(), path_ / "0002-monday" / "map.gridmap.gz");
  EXPECT_EQ(changes_text(add(true).changes), "") << "compared with the second run, which has the wall, too";
  EXPECT_EQ(SiteFolder(path_).runs().size(), 3U);
  fs::remove_all(path_ / "0001-monday");
  EXPECT_EQ(SiteFolder(path_).runs().size(), 3U) << "later runs do not need the first one";
  EXPECT_EQ(SiteFolder(path_).newest_map(), path_ / "0004-monday" / "map.gridmap.gz")
      << "the number of a deleted run is not used again";
  for (const char* folder : {"0002-monday", "0004-monday"}) fs::remove_all(path_ / folder);
  EXPECT_THAT(failure(), HasSubstr("site.json lists 3 runs, but the folder of none of them exists"));
}

TEST_F(SiteFolderTest, numbers_of_runs_that_did_not_fit_are_taken) {
  add(false);
  fs::create_directories(path_ / "0002-elsewhere");
  const SiteFolder site(path_);
  EXPECT_EQ(site.newest_map(), path_ / "0001-monday" / "map.gridmap.gz");
  EXPECT_EQ(site.folder_of_next("tuesday"), path_ / "0003-tuesday");
}

TEST_F(SiteFolderTest, refuses_what_is_no_site) {
  fs::create_directories(path_);
  write_file(path_ / "thesis.txt", "");
  EXPECT_THAT(failure(), HasSubstr("office is not empty and has no site.json"));
  write_file(path_ / "site.json", "{");
  EXPECT_THAT(failure(), HasSubstr("site.json is damaged"));
  write_file(path_ / "site.json", R"({"schema": "psi-slam site", "schema_version": 2, "runs": []})");
  EXPECT_THAT(failure(), HasSubstr("version 1"));
  fs::remove_all(path_);
  write_file(path_, "");
  EXPECT_THAT(failure(), HasSubstr("office is a file"));
}

TEST_F(SiteFolderTest, refuses_a_newest_run_without_map) {
  add(false);
  fs::remove(path_ / "0001-monday" / "map.gridmap.gz");
  EXPECT_THAT(failure(), HasSubstr("0001-monday: this run of the site has no map"));
}

}  // namespace
}  // namespace psi_slam
