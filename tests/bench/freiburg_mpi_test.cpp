// SPDX-License-Identifier: BSD-3-Clause
#ifdef PSI_SLAM_MPIRUN

#include <cstdlib>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>

#include "batch/child_process.h"
#include "command_fixture.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using Json = nlohmann::json;

class FreiburgByMpi : public BenchCommand {
 protected:
  FreiburgByMpi() : BenchCommand("freiburg") {
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
    ::setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
    ::setenv("OMPI_MCA_btl_vader_single_copy_mechanism", "none", 1);  // containers may forbid this mechanism
    write_room();
  }

  fs::path output(const std::string& name) const { return folder_.path() / name; }

  ChildWords with_output(ChildWords first, const std::string& name) const {
    const auto rest =
        words("freiburg", {"-o", output(name).string(), "--matchers", "csm,ga", "--seeds", "3"});
    first.insert(first.end(), rest.begin(), rest.end());
    return first;
  }
  ChildEnd by_processes(const std::string& name) const {
    return run_child({with_output({PSI_SLAM_BENCH_PROGRAM}, name)});
  }
  ChildEnd by_mpi(const std::string& name, const std::function<bool()>& stop = {}) const {
    ChildWords all =
        with_output({PSI_SLAM_MPIRUN, "--oversubscribe", "-n", "3", PSI_SLAM_BENCH_PROGRAM}, name);
    all.emplace_back("--mpi");
    return run_child({all, 0, stop});
  }

  static bool is_being_written(const fs::path& file) { return file.filename().string().front() == '.'; }

  /// Results of the runs by file name, without times and memory.
  std::map<std::string, Json> figures(const std::string& name) const {
    std::map<std::string, Json> all;
    for (const auto& file : fs::directory_iterator(output(name) / "runs")) {
      if (is_being_written(file.path())) continue;
      Json run = Json::parse(read_file(file.path()));
      for (const char* took : {"wall_s", "cpu_s", "peak_memory_mib"}) run["figures"].erase(took);
      all[file.path().filename().string()] = run["figures"];
    }
    return all;
  }
  std::map<std::string, fs::file_time_type> times(const std::string& name) const {
    std::map<std::string, fs::file_time_type> all;
    for (const auto& file : fs::directory_iterator(output(name) / "runs"))
      if (!is_being_written(file.path())) all[file.path().filename().string()] = file.last_write_time();
    return all;
  }
};

TEST_F(FreiburgByMpi, gives_the_same_figures_as_processes_and_a_page) {
  const ChildEnd processes = by_processes("processes");
  ASSERT_EQ(processes.code, 0) << processes.err;
  const ChildEnd mpi = by_mpi("mpi");
  ASSERT_EQ(mpi.code, 0) << mpi.err;
  EXPECT_EQ(figures("mpi").size(), 4U);
  EXPECT_EQ(figures("mpi"), figures("processes"));
  EXPECT_EQ(mpi.out, read_file(output("mpi") / "freiburg.md"));
  EXPECT_THAT(mpi.out, HasSubstr("| room | ga | 3 | 0.0"));

  const auto made = times("processes");
  const ChildEnd again = by_mpi("processes");  // all runs exist already, made without MPI
  ASSERT_EQ(again.code, 0) << again.err;
  EXPECT_EQ(times("processes"), made) << "kept runs are not repeated";
}

TEST_F(FreiburgByMpi, the_same_command_continues_a_killed_job) {
  const auto runs = output("mpi") / "runs";
  by_mpi("mpi", [&] { return fs::exists(runs / "room-csm-1.json") || fs::exists(runs / "room-ga-1.json"); });
  const auto kept = times("mpi");
  ASSERT_FALSE(kept.empty());
  const ChildEnd rest = by_mpi("mpi");
  ASSERT_EQ(rest.code, 0) << rest.err;
  EXPECT_EQ(figures("mpi").size(), 4U);
  const auto now = times("mpi");
  for (const auto& [name, time] : kept) EXPECT_EQ(now.at(name), time) << name;
}

TEST_F(FreiburgByMpi, mistakes_are_reported_once_with_exit_code_2) {
  const auto fails = [](const ChildWords& arguments, const std::string& sentence) {
    ChildWords all{PSI_SLAM_MPIRUN,        "--oversubscribe", "-n",   "3",
                   PSI_SLAM_BENCH_PROGRAM, "freiburg",        "--mpi"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    const ChildEnd end = run_child({all});
    EXPECT_EQ(end.code, 2) << end.err;
    EXPECT_THAT(end.err, HasSubstr(sentence));
    EXPECT_EQ(end.err.find("psi-slam-mpi: "), end.err.rfind("psi-slam-mpi: ")) << end.err;
  };
  fails({"--data", folder_.path().string() + "/none"}, "none is not a folder");
  fails({"--processes", "2"}, "--processes contradicts --mpi: each rank makes one run at a time");
  fails({"--baselines"}, "--baselines contradicts --mpi: baselines run on one machine");
  fails({"--baseline-limit-s", "5"}, "--baseline-limit-s contradicts --mpi");
}

}  // namespace
}  // namespace psi_slam

#endif
