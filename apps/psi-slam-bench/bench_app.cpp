// SPDX-License-Identifier: BSD-3-Clause
#include "bench_app.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <ostream>

#include "bench_progress.h"
#include "benchmark_logs.h"
#include "match_benchmark.h"
#include "match_report.h"
#include "psi_slam/base/atomic_file.h"
#include "psi_slam/base/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr int kDone = 0;
constexpr int kFailed = 1;
constexpr int kWrongUsageOrInput = 2;

struct MatchCommand {
  std::string data;
  std::string ini;
  std::string json;
  std::string output;
  MatchBenchmarkOptions options;
};

void add_match(CLI::App& app, MatchCommand& command) {
  CLI::App* const match = app.add_subcommand("match", "Compare the matchers on loops drawn from real logs");
  match->add_option("--data", command.data, "Folder of the logs: NAME.clf.gz with NAME.relations")
      ->required()
      ->type_name("DIR");
  match->add_option("--ini", command.ini, "Folder of their settings NAME.ini; default: those of psi-slam")
      ->type_name("DIR");
  match->add_option("--json", command.json, "Write the figures to this file; one that is there is replaced")
      ->type_name("FILE");
  match
      ->add_option("--cases", command.options.cases,
                   "Positive cases from each log, and as many negative ones")
      ->check(CLI::Range(1, 1'000'000))
      ->capture_default_str();
  match->add_option("--seed", command.options.seed, "Of the cases and of the random matchers")
      ->capture_default_str();
  match->add_flag("--windows", command.options.windows,
                  "Also compare over window sizes and sizes of local maps");
  match
      ->add_option("-o,--output", command.output,
                   "Folder for match.md and the plots; those that are there are replaced")
      ->type_name("DIR");
}

/// Told before the work, which is long.
void check_writable(const fs::path& file) {
  const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
  if (fs::is_directory(file)) throw UserError(file.string() + " is a folder: name a file");
  if (!fs::is_directory(folder)) throw UserError("the folder of " + file.string() + " does not exist");
  if (::access(folder.c_str(), W_OK) != 0) throw UserError(file.string() + " cannot be written");
}

void prepare_folder(const fs::path& folder) {
  std::error_code failed;
  fs::create_directories(folder, failed);
  if (failed || !fs::is_directory(folder))
    throw UserError("the folder " + folder.string() + " cannot be made: " + failed.message());
  check_writable(folder / "match.md");
}

fs::path ini_folder(const std::string& given) {
  if (!given.empty()) return given;
  if (const auto shipped = shipped_ini_folder()) return *shipped;
  throw UserError("name the folder of the logs' settings: --ini DIR");
}

void match(const MatchCommand& command, const Streams& streams) {
  const std::vector<BenchmarkLog> logs = find_benchmark_logs(command.data, ini_folder(command.ini));
  if (!command.json.empty()) check_writable(command.json);
  if (!command.output.empty()) prepare_folder(command.output);
  BenchProgress progress(streams.err_is_terminal ? &streams.err : nullptr);
  const MatchBenchmark benchmark = run_match_benchmark(
      logs, command.options,
      [&](const std::string& doing, double done, double all) { progress.show(doing, done, all); });
  progress.clear();

  const std::string machine = machine_text();
  const std::string page = match_markdown(benchmark, command.options, machine);
  if (!command.json.empty())
    write_text_atomically(command.json, match_json(benchmark, command.options, machine));
  if (!command.output.empty()) {
    const fs::path folder = command.output;
    write_text_atomically(folder / "match.md", page);
    if (command.options.windows) {
      write_text_atomically(folder / "match-windows.svg", window_plot(benchmark));
      write_text_atomically(folder / "match-local-maps.svg", local_map_plot(benchmark));
    }
  }
  streams.out << page << std::flush;
  if (!streams.out) throw SystemFailure("cannot write to standard output");
}

}  // namespace

int run_bench_app(const std::vector<std::string>& arguments, const Streams& streams) noexcept {
  CLI::App app("psi-slam-bench measures how good and how fast the parts of psi-slam are.", "psi-slam-bench");
  try {
    MatchCommand command;
    add_match(app, command);
    app.require_subcommand(1);
    app.set_version_flag("--version", "psi-slam-bench " PSI_SLAM_VERSION, "Print the version, and exit");
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11 takes them last first
    match(command, streams);
    return kDone;
  } catch (const CLI::Success& asked) {  // --help, --version
    app.exit(asked, streams.out, streams.err);
    return kDone;
  } catch (const CLI::ParseError& error) {
    streams.err << "psi-slam-bench: " << error.what() << " (see psi-slam-bench match --help)\n";
    return kWrongUsageOrInput;
  } catch (const UserError& error) {
    streams.err << "psi-slam-bench: " << error.what() << '\n';
    return kWrongUsageOrInput;
  } catch (const std::exception& error) {
    streams.err << "psi-slam-bench: " << error.what() << '\n';
    return kFailed;
  }
}

}  // namespace psi_slam
