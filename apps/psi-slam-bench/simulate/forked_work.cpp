// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/forked_work.h"

#include <sys/wait.h>
#include <unistd.h>

#include <exception>
#include <stdexcept>

#include "base/forked_child.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

// The first character of a message is its kind. Messages end with a zero byte.
constexpr char kReport = 'r';
constexpr char kResult = 't';
constexpr char kUserError = 'u';
constexpr char kFailure = 'f';

void send(int pipe, char kind, const std::string& text) {
  if (!write_all(pipe, kind + text + '\0')) ::_exit(1);  // the parent no longer reads
}

}  // namespace

std::string run_forked(const std::function<std::string(const TextObserver& report)>& work,
                       const TextObserver& observer) {
  Pipe pipe;
  const pid_t pid = ::fork();
  if (pid < 0) throw SystemFailure("cannot start a child process: too many processes, or too little memory");
  if (pid == 0) {
    pipe.close_reading();
    try {
      send(pipe.writing(), kResult,
           work([&](const std::string& report) { send(pipe.writing(), kReport, report); }));
    } catch (const UserError& error) {
      send(pipe.writing(), kUserError, error.what());
    } catch (const std::exception& error) {
      send(pipe.writing(), kFailure, error.what());
    }
    ::_exit(0);  // calls no destructors and flushes no stream buffers of the parent
  }
  RunningChild child(pid);
  pipe.close_writing();
  std::string bytes;
  std::string last;
  while (pipe.read_to(bytes))
    for (std::size_t end = 0; (end = bytes.find('\0')) != std::string::npos; bytes.erase(0, end + 1)) {
      const std::string message = bytes.substr(0, end);
      if (message[0] == kReport)
        observer(message.substr(1));
      else
        last = message;
    }
  const int status = child.wait().status;
  if (last.empty())
    throw SystemFailure(WIFSIGNALED(status)
                            ? "a child process was killed by signal " + std::to_string(WTERMSIG(status))
                            : "a child process ended without a result");
  if (last[0] == kUserError) throw UserError(last.substr(1));
  if (last[0] == kFailure) throw SystemFailure(last.substr(1));
  return last.substr(1);
}

}  // namespace psi_slam
