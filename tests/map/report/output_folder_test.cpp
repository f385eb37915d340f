// SPDX-License-Identifier: BSD-3-Clause
#include "map/report/output_folder.h"

#include <gmock/gmock.h>
#include <sys/resource.h>

#include <csignal>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <set>

#include "base/partial_files.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/user_error.h"
#include "simulated_room.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

const RunInfo kInfo{"0.1.0", "room.clf", {}};

std::string contents(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::set<std::string> names_in(const fs::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
  return names;
}

std::string complaint(const fs::path& path, bool force = false, const std::string& force_text = "--force") {
  try {
    OutputFolder::prepare(path, force, force_text);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no complaint";
}

void export_room(const OutputFolder& folder) {
  const MappingResult result = walk_around_the_room();
  const auto grid = draw_grid_map(result.log, mapped_poses(result));
  MapFileOptions options;
  options.geotiff = options.gpkg = true;
  WorkerPool pool(2);
  pool.run(path_file_tasks(result, result.log, folder, options));
  pool.run(map_file_tasks(folder.path(), result, *grid, {}, options));
  export_account(result, kInfo, summarize_run(result, *grid), *grid, folder);
}

TEST(OutputFolder, creates_the_folder_and_its_parents) {
  const TemporaryFolder temporary;
  const fs::path path = temporary.path() / "runs" / "first";
  EXPECT_EQ(OutputFolder::prepare(path, false).path(), path);
  EXPECT_TRUE(fs::is_directory(path));
  EXPECT_EQ(complaint(path), "no complaint") << "an empty folder needs no force";
}

TEST(OutputFolder, needs_force_unless_empty) {
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / "notes.txt") << "x";
  EXPECT_THAT(complaint(temporary.path()), AllOf(HasSubstr("is not empty"), HasSubstr("with --force")));
  EXPECT_THAT(complaint(temporary.path(), false, "force=True"),
              EndsWith("replace the results in it with force=True"));
  EXPECT_EQ(complaint(temporary.path(), true), "no complaint");
}

TEST(OutputFolder, reports_paths_that_cannot_be_a_folder) {
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / "file") << "x";
  EXPECT_THAT(complaint(temporary.path() / "file"), HasSubstr("is a file, not a folder"));
  EXPECT_THAT(complaint(temporary.path() / "file" / "below"),
              HasSubstr((temporary.path() / "file").string() + " is a file"));
  EXPECT_THAT(complaint(temporary.path() / "file", true), HasSubstr("is a file, not a folder"));
  EXPECT_THAT(complaint(""), HasSubstr("name of the output folder is empty"));
  if (fs::exists("/proc/self")) {
    EXPECT_THAT(complaint("/proc/psi-slam"), HasSubstr("cannot create the output folder /proc/psi-slam"));
  }
}

TEST(OutputFolder, has_all_files_under_fixed_names) {
  const TemporaryFolder temporary;
  export_room(OutputFolder::prepare(temporary.path() / "run", false));
  EXPECT_EQ(names_in(temporary.path() / "run"),
            (std::set<std::string>{"frames.csv", "graph.g2o", "loops.csv", "map.dxf", "map.gpkg",
                                   "map.gridmap.gz", "map.pgm", "map.png", "map.simplemap.gz", "map.svg",
                                   "map.tif", "map.yaml", "report.html", "summary.json", "trajectory.carmen",
                                   "trajectory.csv", "trajectory.tum"}));
}

TEST(OutputFolder, force_replaces_results_and_keeps_other_files) {
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / "notes.txt") << "mine";
  std::ofstream(temporary.path() / "map.yaml") << "old";
  export_room(OutputFolder::prepare(temporary.path(), true));
  EXPECT_EQ(contents(temporary.path() / "notes.txt"), "mine");
  EXPECT_THAT(contents(temporary.path() / "map.yaml"), HasSubstr("image: map.pgm"));
}

TEST(OutputFolder, replaced_results_lose_the_files_that_the_new_ones_do_not_have) {
  const TemporaryFolder temporary;
  const std::set<std::string> outdated{"map.tif",           "map.gridmap.gz",    "trajectory-1.tum",
                                       "trajectory-12.tum", "trajectory.carmen", "speed_mask.pgm",
                                       "zones.txt",         "loops.edits",       "map_print.png"};
  const std::set<std::string> others{"map.txt", "my.edits", "trajectory-0.tum", "report.html", "maps.png"};
  for (const std::string& name : outdated) std::ofstream(temporary.path() / name) << "old";
  for (const std::string& name : others) std::ofstream(temporary.path() / name) << "kept";
  OutputFolder::prepare(temporary.path(), true).replace_results([&](const OutputFolder& folder) {
    std::ofstream(folder.path() / "map.png") << "new";
    EXPECT_EQ(contents(temporary.path() / "map.tif"), "old") << "until the new results are complete";
  });
  std::set<std::string> expected = others;
  expected.insert("map.png");
  EXPECT_EQ(names_in(temporary.path()), expected);
}

TEST(OutputFolder, results_that_cannot_be_written_leave_the_old_ones) {
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / "map.png") << "old";
  const OutputFolder folder = OutputFolder::prepare(temporary.path(), true);
  EXPECT_THROW(folder.replace_results([](const OutputFolder& results) {
    std::ofstream(results.path() / "map.png") << "new";
    throw SystemFailure("the disk is full");
  }),
               SystemFailure);
  EXPECT_EQ(contents(temporary.path() / "map.png"), "old");
  EXPECT_EQ(names_in(temporary.path()), std::set<std::string>{"map.png"});
}

TEST(OutputFolder, is_empty_if_it_only_has_temporary_files_of_a_killed_program) {
  const TemporaryFolder temporary;
  std::ofstream(temporary.path() / new_partial_name("map.png")) << "half";
  EXPECT_EQ(complaint(temporary.path()), "no complaint");
  std::ofstream(temporary.path() / ".hidden") << "x";
  EXPECT_THAT(complaint(temporary.path()), HasSubstr("is not empty"));
}

TEST(OutputFolder, equal_results_give_equal_bytes) {
  const TemporaryFolder temporary;
  export_room(OutputFolder::prepare(temporary.path() / "a", false));
  export_room(OutputFolder::prepare(temporary.path() / "b", false));
  for (const std::string& name : names_in(temporary.path() / "a")) {
    if (name == "summary.json" || name == "report.html") continue;  // these files contain the memory used
    EXPECT_EQ(contents(temporary.path() / "a" / name), contents(temporary.path() / "b" / name)) << name;
  }
}

/// Exports in a child process whose files cannot exceed `limit` bytes, as on a full disk. The limit also
/// holds for its standard error, which is a file.
[[noreturn]] void export_to_a_full_disk(const fs::path& path, rlim_t limit) {
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit bytes{limit, limit};
  setrlimit(RLIMIT_FSIZE, &bytes);
  try {
    export_room(OutputFolder::prepare(path, false));
  } catch (const SystemFailure& failure) {
    std::fprintf(stderr, "%s\n", failure.what());
    std::exit(1);
  }
  std::exit(0);
}

TEST(OutputFolderDeathTest, reports_a_full_disk_and_leaves_no_partial_file) {
  const TemporaryFolder temporary;
  for (const rlim_t limit : {1000, 4096, 10000, 30000}) {
    const fs::path path = temporary.path() / std::to_string(limit);
    EXPECT_EXIT(export_to_a_full_disk(path, limit), ::testing::ExitedWithCode(1),
                "cannot write "
                ".*/"
                "(trajectory.tum|trajectory.csv|trajectory.carmen|frames.csv|loops.csv|map.*|summary.json|"
                "report.html): File "
                "too large");
    for (const std::string& name : names_in(path)) {
      EXPECT_EQ(name.find("partial"), std::string::npos) << name;
      EXPECT_GT(fs::file_size(path / name), 0U) << name;
    }
  }
}

}  // namespace
}  // namespace psi_slam
