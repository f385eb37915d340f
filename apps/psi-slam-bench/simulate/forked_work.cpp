// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/forked_work.h"

#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <exception>
#include <stdexcept>

#include "batch/child_process.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

// First character of a message. Messages end with a zero.
constexpr char kReport = 'r';
constexpr char kResult = 't';
constexpr char kUserError = 'u';
constexpr char kFailure = 'f';

void send(int pipe, char kind, const std::string& text) {
  const std::string message = kind + text + '\0';
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t written = ::write(pipe, message.data() + sent, message.size() - sent);
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) ::_exit(1);  // the parent no longer reads
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
  ::_exit(0);  // without destructors and stream buffers of the parent
}

/// Removes complete messages from `bytes`. Passes reports to `observer` and stores the last other message in
/// `last`.
void take_messages(std::string& bytes, std::string& last,
                   const std::function<void(const std::string&)>& observer) {
  std::size_t begin = 0;
  for (std::size_t end = bytes.find('\0'); end != std::string::npos; end = bytes.find('\0', begin)) {
    const std::string message = bytes.substr(begin, end - begin);
    begin = end + 1;
    if (message[0] == kReport) {
      observer(message.substr(1));
    } else {
      last = message;
    }
  }
  bytes.erase(0, begin);
}

}  // namespace

ForkedResult run_forked(
    const std::function<std::string(const std::function<void(const std::string&)>&)>& work,
    const std::function<void(const std::string&)>& observer) {
  Pipe pipe;
  const pid_t pid = ::fork();
  if (pid < 0) throw SystemFailure("cannot start a child process");
  if (pid == 0) {
    pipe.close_reading();
    be_the_child(pipe.writing(), work);
  }
  RunningChild child(pid);
  pipe.close_writing();
  std::string bytes;
  std::string last;
  while (pipe.read_to(bytes)) take_messages(bytes, last, observer);
  const EndedChild end = child.wait();
  if (last.empty()) {
    throw SystemFailure(WIFSIGNALED(end.status)
                            ? "a child process was killed by signal " + std::to_string(WTERMSIG(end.status))
                            : "a child process ended without a result");
  }
  if (last[0] == kUserError) throw UserError(last.substr(1));
  if (last[0] == kFailure) throw SystemFailure(last.substr(1));
  return {last.substr(1), end.peak_memory_mib};
}

}  // namespace psi_slam
