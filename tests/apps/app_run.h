// SPDX-License-Identifier: BSD-3-Clause
// Helpers for tests of psi-slam: run the program in this process or as a child process, and read its results.
#pragma once

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "psi_slam_app.h"

namespace psi_slam {

/// Path of a short real rawlog that Debian's package mrpt-common installs.
inline constexpr const char* kQuickstartLog =
    "/usr/share/mrpt/datasets/2006-01ENE-21-SENA_Telecom Faculty_one_loop_only.rawlog";
inline constexpr const char* kNeedsQuickstartLog = "needs the rawlogs of Debian's package mrpt-common";

/// Names of all result files of a run with default settings, in alphabetical order.
inline const std::vector<std::string>& result_names() {
  static const std::vector<std::string> kNames{
      "frames.csv",  "graph.g2o",    "loops.csv",         "map.dxf",        "map.gridmap.gz",
      "map.pgm",     "map.png",      "map.simplemap.gz",  "map.svg",        "map.yaml",
      "report.html", "summary.json", "trajectory.carmen", "trajectory.csv", "trajectory.tum"};
  return kNames;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

inline void write_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!file.flush()) throw std::runtime_error("cannot write " + path.string());
}

/// Exit code and output of a run.
struct AppRun {
  int code = -1;
  std::string out;
  std::string err;
};

inline AppRun run_app(const std::vector<std::string>& arguments, bool err_is_terminal = false) {
  std::ostringstream out;
  std::ostringstream err;
  const int code = run_psi_slam_app(arguments, {out, err, err_is_terminal});
  return {code, out.str(), err.str()};
}

/// Runs the program as a child process, which is killed with the object unless finish() was called. Its
/// standard output and error go to files in `folder`.
class AppProcess {
 public:
  /// Starts `program` in a new process. `prepare` runs in this process before the program does.
  AppProcess(
      const std::vector<std::string>& arguments, std::filesystem::path folder,
      const std::function<void()>& prepare = [] {}, const std::string& program = PSI_SLAM_PROGRAM)
      : folder_(std::move(folder)) {
    std::vector<std::string> words{program};
    words.insert(words.end(), arguments.begin(), arguments.end());
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    const std::string out = (folder_ / "stdout").string();
    const std::string err = (folder_ / "stderr").string();
    pid_ = ::fork();
    if (pid_ < 0) throw std::runtime_error("cannot fork");
    if (pid_ > 0) return;
    constexpr int kMode = 0600;
    ::dup2(::open(out.c_str(), O_CREAT | O_TRUNC | O_WRONLY, kMode), STDOUT_FILENO);
    ::dup2(::open(err.c_str(), O_CREAT | O_TRUNC | O_WRONLY, kMode), STDERR_FILENO);
    prepare();
    ::execv(pointers[0], pointers.data());
    ::_exit(127);
  }

  ~AppProcess() {
    if (finished_) return;
    send(SIGKILL);
    ::waitpid(pid_, nullptr, 0);
  }
  AppProcess(const AppProcess&) = delete;
  AppProcess& operator=(const AppProcess&) = delete;

  pid_t pid() const { return pid_; }
  void send(int signal) const { ::kill(pid_, signal); }

  /// Waits until the process ends. The exit code is the negative signal number if a signal ended the process.
  AppRun finish() const {
    int status = 0;
    ::waitpid(pid_, &status, 0);
    finished_ = true;
    const int code = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
    return {code, bytes_of(folder_ / "stdout"), bytes_of(folder_ / "stderr")};
  }

 private:
  std::filesystem::path folder_;
  pid_t pid_ = -1;
  mutable bool finished_ = false;  // the process may not be signalled after it was waited for
};

}  // namespace psi_slam
