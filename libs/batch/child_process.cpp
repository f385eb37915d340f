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

#include "base/forked_child.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kPollTimeout_ms = 200;
constexpr std::size_t kMostOut = std::size_t{16} << 20;
constexpr std::size_t kMostErr = std::size_t{64} << 10;

/// Appends the next bytes of the pipe to `text` and keeps at least the last `most` bytes of `text`. Returns
/// false at the end of the data.
bool take(Pipe& pipe, std::string& text, std::size_t most) {
  const bool more = pipe.read_to(text);
  if (text.size() > 2 * most) text.erase(0, text.size() - most);
  return more;
}

/// Replaces the forked process by the program. Makes only system calls, which are always safe after fork().
/// The process ends with its parent and does not receive the terminal's Ctrl-C. Writes errno to `error_pipe`
/// if the program cannot be started.
[[noreturn]] void start_program(char* const* words, int out, int err, int error_pipe, pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // the parent has already ended
  ::setpgid(0, 0);
  const int in = ::open("/dev/null", O_RDONLY);
  if (in >= 0 && ::dup2(in, STDIN_FILENO) >= 0 && ::dup2(out, STDOUT_FILENO) >= 0 &&
      ::dup2(err, STDERR_FILENO) >= 0)
    ::execv(words[0], words);
  const int error = errno;
  const ssize_t written = ::write(error_pipe, &error, sizeof error);
  ::_exit(written < 0 ? 1 : 127);
}

pid_t start(const ChildProcess& child, const Pipe& out, const Pipe& err) {
  std::vector<std::string> words = child.words;
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  Pipe error_pipe;  // closes when the program starts; otherwise receives errno
  const pid_t parent = ::getpid();
  const pid_t pid = ::fork();
  if (pid < 0) fail_at("cannot start " + words.at(0), errno);
  if (pid == 0) start_program(pointers.data(), out.writing(), err.writing(), error_pipe.writing(), parent);
  error_pipe.close_writing();
  std::string received;
  while (error_pipe.read_to(received)) {
  }
  int error = 0;
  if (received.size() < sizeof error) return pid;
  std::memcpy(&error, received.data(), sizeof error);
  ::waitpid(pid, nullptr, 0);
  fail_at("cannot start " + words[0], error);
}

/// Last line of a text, without the white space at its end.
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

std::string ChildEnd::failure_without(const std::string& prefix) const {
  const std::string text = failure();
  return text.compare(0, prefix.size(), prefix) == 0 ? text.substr(prefix.size()) : text;
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
    const int ready = ::poll(ends.data(), ends.size(), kPollTimeout_ms);
    if (ready < 0 && errno != EINTR) fail_at("cannot wait for the output of " + child.words[0], errno);
    if (ready > 0) {  // otherwise poll() has not updated revents
      // poll() ignores negative descriptors.
      if (ends[0].revents != 0 && !take(out, end.out, kMostOut)) ends[0].fd = -1;
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

std::optional<ChildEnd> run_to_end(const ChildWords& words, const std::function<bool()>& stop) {
  try {
    ChildEnd end = run_child({words, 0, stop});
    if (end.stopped && end.code != 0) return std::nullopt;
    return end;
  } catch (const SystemFailure& failure) {
    ChildEnd end;
    end.err = failure.what();
    return end;
  }
}

}  // namespace psi_slam
