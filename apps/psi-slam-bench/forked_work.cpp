// SPDX-License-Identifier: BSD-3-Clause
#include "forked_work.h"

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <exception>
#include <stdexcept>

#include "psi_slam/base/user_error.h"

namespace psi_slam {
namespace {

// The first character of each message, which ends with a zero.
constexpr char kReport = 'r';
constexpr char kResult = 't';
constexpr char kUserError = 'u';
constexpr char kFailure = 'f';

void send(int pipe, char kind, const std::string& text) {
  const std::string message = kind + text + '\0';
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t written = ::write(pipe, message.data() + sent, message.size() - sent);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);  // nobody listens any more
    sent += static_cast<std::size_t>(written);
  }
}

[[noreturn]] void be_the_child(
    int pipe, const std::function<std::string(const std::function<void(const std::string&)>&)>& work) {
  try {
    send(pipe, kResult, work([pipe](const std::string& report) { send(pipe, kReport, report); }));
  } catch (const UserError& error) {
    send(pipe, kUserError, error.what());
  } catch (const std::exception& error) {
    send(pipe, kFailure, error.what());
  }
  ::_exit(0);  // neither destructors nor streams of the parent
}

/// Takes the messages until the child closes its end; the last one that is no report is left.
std::string listen(int pipe, const std::function<void(const std::string&)>& observer) {
  std::string last;
  std::string message;
  std::array<char, 4096> buffer{};
  for (;;) {
    const ssize_t got = ::read(pipe, buffer.data(), buffer.size());
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) return last;
    for (ssize_t i = 0; i < got; ++i) {
      const char c = buffer[static_cast<std::size_t>(i)];
      if (c != '\0') {
        message += c;
        continue;
      }
      if (message[0] == kReport) {
        observer(message.substr(1));
      } else {
        last = message;
      }
      message.clear();
    }
  }
}

/// Waits for the child when its scope ends, however that is: one that still works is not needed any more.
class Child {
 public:
  Child(pid_t pid, int pipe) : pid_(pid), pipe_(pipe) {}
  ~Child() {
    if (pid_ > 0) {
      ::kill(pid_, SIGKILL);
      wait();
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  int pipe() const { return pipe_; }

  rusage wait() {
    rusage usage{};
    ::close(pipe_);
    while (::wait4(pid_, &status_, 0, &usage) < 0 && errno == EINTR) {
    }
    pid_ = 0;
    return usage;
  }
  int status() const { return status_; }

 private:
  pid_t pid_;
  int pipe_;
  int status_ = 0;
};

}  // namespace

ForkedResult run_forked(
    const std::function<std::string(const std::function<void(const std::string&)>&)>& work,
    const std::function<void(const std::string&)>& observer) {
  std::array<int, 2> ends{};
  if (::pipe(ends.data()) != 0) throw SystemFailure("cannot make a pipe to a child process");
  const pid_t pid = ::fork();
  if (pid < 0) {
    ::close(ends[0]);
    ::close(ends[1]);
    throw SystemFailure("cannot start a child process");
  }
  if (pid == 0) {
    ::close(ends[0]);
    be_the_child(ends[1], work);
  }
  ::close(ends[1]);
  Child child(pid, ends[0]);
  const std::string last = listen(child.pipe(), observer);
  const rusage usage = child.wait();
  if (last.empty()) {
    throw SystemFailure(WIFSIGNALED(child.status()) ? "a child process was ended by signal " +
                                                          std::to_string(WTERMSIG(child.status()))
                                                    : "a child process ended without a result");
  }
  if (last[0] == kUserError) throw UserError(last.substr(1));
  if (last[0] == kFailure) throw SystemFailure(last.substr(1));
  return {last.substr(1), static_cast<double>(usage.ru_maxrss) / 1024};  // Linux counts kibibytes
}

}  // namespace psi_slam
