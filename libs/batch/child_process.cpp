// SPDX-License-Identifier: BSD-3-Clause
#include "batch/child_process.h"

#include <fcntl.h>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>

#include "psi_slam/user_error.h"
#include "batch/running_child.h"

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kBetweenLooks_ms = 200;
constexpr std::size_t kMostOut = std::size_t{16} << 20;
constexpr std::size_t kMostErr = std::size_t{64} << 10;

[[noreturn]] void fail(const std::string& doing, int error) {
  throw SystemFailure(doing + ": " + std::strerror(error));
}

/// Takes what is there, of which the last `most` bytes are kept. False at the end.
bool take(Pipe& pipe, std::string& text, std::size_t most) {
  const bool more = pipe.read_to(text);
  if (text.size() > 2 * most) text.erase(0, text.size() - most);
  return more;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

/// In the new process, where nothing but system calls is safe. It ends with the process that started it, and
/// is out of reach of its terminal's Ctrl-C. Says through `complaint` why there is no program.
[[noreturn]] void become(char* const* words, int out, int err, int complaint, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it has ended already
  ::setpgid(0, 0);
  const int in = ::open("/dev/null", O_RDONLY);
  if (in >= 0 && ::dup2(in, STDIN_FILENO) >= 0 && ::dup2(out, STDOUT_FILENO) >= 0 &&
      ::dup2(err, STDERR_FILENO) >= 0)
    ::execv(words[0], words);
  const int error = errno;
  const ssize_t told = ::write(complaint, &error, sizeof error);
  ::_exit(told < 0 ? 1 : 127);
}

pid_t start(const ChildProcess& child, const Pipe& out, const Pipe& err) {
  std::vector<std::string> words = child.words;
  const std::vector<char*> pointers = pointers_to(words);
  Pipe complaint;  // closes when the program begins
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) fail("cannot start " + words.at(0), errno);
  if (pid == 0) become(pointers.data(), out.writing(), err.writing(), complaint.writing(), parent);
  complaint.close_writing();
  std::string told;
  while (complaint.read_to(told)) {
  }
  int error = 0;
  if (told.size() < sizeof error) return pid;
  std::memcpy(&error, told.data(), sizeof error);
  ::waitpid(pid, nullptr, 0);
  fail("cannot start " + words[0], error);
}

/// The last line that says something.
std::string last_line(std::string text) {
  while (!text.empty() && std::strchr(" \t\r\n", text.back()) != nullptr) text.pop_back();
  return text.substr(text.rfind('\n') + 1);  // npos + 1 is 0
}

}  // namespace

std::string ChildEnd::failure() const {
  if (code == 0) return {};
  if (stopped) return "interrupted";
  if (over_time) return "stopped at its time limit";
  if (signal != 0) return std::string("ended by a signal: ") + ::strsignal(signal);
  const std::string words = last_line(err);
  return words.empty() ? "ended with code " + std::to_string(code) : words;
}

ChildEnd run_child(const ChildProcess& child) {
  Pipe out;
  Pipe err;
  ChildEnd end;
  const Clock::time_point began = Clock::now();
  const auto elapsed_s = [&] { return std::chrono::duration<double>(Clock::now() - began).count(); };
  RunningChild running(start(child, out, err));
  out.close_writing();
  err.close_writing();
  std::array<pollfd, 2> ends{{{out.reading(), POLLIN, 0}, {err.reading(), POLLIN, 0}}};
  while (ends[0].fd >= 0 || ends[1].fd >= 0) {
    const int ready = ::poll(ends.data(), ends.size(), kBetweenLooks_ms);
    if (ready < 0 && errno != EINTR) fail("cannot wait for the words of " + child.words[0], errno);
    if (ready > 0) {  // else what the ends say is of the time before
      if (ends[0].revents != 0 && !take(out, end.out, kMostOut)) ends[0].fd = -1;  // poll() passes it over
      if (ends[1].revents != 0 && !take(err, end.err, kMostErr)) ends[1].fd = -1;
    }
    if (end.over_time || end.stopped) continue;
    end.over_time = child.time_limit_s > 0 && elapsed_s() > child.time_limit_s;
    end.stopped = child.stop && child.stop();
    if (end.over_time || end.stopped) running.kill();
  }
  const EndedChild ended = running.wait();
  end.wall_s = elapsed_s();
  end.cpu_s = ended.cpu_s;
  end.peak_memory_mib = ended.peak_memory_mib;
  if (WIFEXITED(ended.status)) end.code = WEXITSTATUS(ended.status);
  if (WIFSIGNALED(ended.status)) end.signal = WTERMSIG(ended.status);
  return end;
}

}  // namespace psi_slam
