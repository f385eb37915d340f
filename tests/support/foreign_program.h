// SPDX-License-Identifier: BSD-3-Clause
// Runs an external program, to test that it reads the files of psi-slam.
#pragma once

#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

namespace psi_slam {

struct ForeignRun {
  static constexpr int kNotInstalled = 77;
  int code = 0;
  std::string out;

  std::vector<double> numbers() const {
    std::istringstream words(out);
    std::vector<double> numbers;
    for (double number = 0; words >> number;) numbers.push_back(number);
    return numbers;
  }
};

/// Runs a shell command and returns its exit code, 128 after a signal, and its standard output.
inline ForeignRun run_foreign(const std::string& command) {
  FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) throw std::runtime_error("cannot run " + command);
  ForeignRun run;
  std::array<char, 4096> piece{};
  while (const std::size_t size = std::fread(piece.data(), 1, piece.size(), pipe))
    run.out.append(piece.data(), size);
  const int status = pclose(pipe);
  run.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128;
  return run;
}

}  // namespace psi_slam
