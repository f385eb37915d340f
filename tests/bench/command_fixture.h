// SPDX-License-Identifier: BSD-3-Clause
// Fixture for tests of the commands of psi-slam-bench: a folder with logs and settings, the program run in
// this process or as a child, and its error messages.
#pragma once

#include <gmock/gmock.h>

#include <sstream>
#include <string>
#include <vector>

#include "batch/child_process.h"
#include "bench_app.h"
#include "room_benchmark.h"
#include "temporary_folder.h"

namespace psi_slam {

class BenchCommand : public testing::Test {
 protected:
  /// `command` is the command that run() and refusal() call with --data and --ini.
  explicit BenchCommand(std::string command = {}) : command_(std::move(command)) {
    for (const std::filesystem::path& folder : {data_, ini_}) std::filesystem::create_directories(folder);
  }

  std::vector<std::string> words(const std::string& command, const std::vector<std::string>& options) const {
    std::vector<std::string> all{command, "--data", data_.string(), "--ini", ini_.string()};
    all.insert(all.end(), options.begin(), options.end());
    return all;
  }

  /// Runs the program in this process with any arguments.
  int run_program(const std::vector<std::string>& arguments, bool terminal = false) {
    out_.str("");
    err_.str("");
    return run_bench_app(arguments, {out_, err_, terminal});
  }

  int run(const std::vector<std::string>& options, bool terminal = false) {
    return run_program(words(command_, options), terminal);
  }

  /// Runs the command with options that it must refuse, and returns the error message.
  std::string refusal(const std::vector<std::string>& options) {
    return refusal_of(words(command_, options));
  }

  std::string refusal_of(const std::vector<std::string>& arguments) {
    EXPECT_EQ(run_program(arguments), 2);
    EXPECT_EQ(out_.str(), "");
    EXPECT_THAT(err_.str(), testing::MatchesRegex("psi-slam-bench: [^\n]+\n")) << "one line";
    return err_.str();
  }

  /// Runs the built program as a child process with `search_path` as PATH.
  static ChildEnd run_process(const std::vector<std::string>& arguments, const std::string& search_path) {
    ChildProcess program;
    program.words = {"/usr/bin/env", "PATH=" + search_path, PSI_SLAM_BENCH_PROGRAM};
    program.words.insert(program.words.end(), arguments.begin(), arguments.end());
    return run_child(program);
  }

  void write_room() const { write_room_benchmark(data_, ini_); }

  TemporaryFolder folder_;
  std::filesystem::path data_ = folder_.path() / "data";
  std::filesystem::path ini_ = folder_.path() / "ini";
  std::ostringstream out_;
  std::ostringstream err_;

 private:
  std::string command_;
};

}  // namespace psi_slam
