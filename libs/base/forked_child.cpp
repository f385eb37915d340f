// SPDX-License-Identifier: BSD-3-Clause
#include "base/forked_child.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstring>
#include <stdexcept>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

double seconds_of(const timeval& time) {
  return static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
}

}  // namespace

void fail_at(const std::string& attempt, int error) {
  throw SystemFailure(attempt + ": " + std::strerror(error));
}

Pipe::Pipe() {
  if (::pipe2(ends_.data(), O_CLOEXEC) != 0) fail_at("cannot create a pipe", errno);
}

Pipe::~Pipe() {
  close_end(0);
  close_end(1);
}

bool Pipe::read_to(std::string& text) {
  std::array<char, 1 << 14> block{};
  const ssize_t count = ::read(ends_[0], block.data(), block.size());
  if (count < 0) return errno == EINTR || errno == EAGAIN;
  text.append(block.data(), static_cast<std::size_t>(count));
  return count > 0;
}

bool Pipe::read_exactly(void* bytes, std::size_t size) const {
  for (std::size_t done = 0; done < size;) {
    const ssize_t count = ::read(ends_[0], static_cast<char*>(bytes) + done, size - done);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    done += static_cast<std::size_t>(count);
  }
  return true;
}

void Pipe::close_end(std::size_t end) {
  if (ends_[end] >= 0) ::close(ends_[end]);
  ends_[end] = -1;
}

bool write_all(int descriptor, std::string_view bytes) {
  while (!bytes.empty()) {
    const ssize_t count = ::write(descriptor, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
  return true;
}

RunningChild::~RunningChild() {
  if (pid_ <= 0) return;
  kill();
  while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
  }
}

void RunningChild::kill() const {
  if (pid_ > 0) ::kill(pid_, SIGKILL);  // 0 and less mean groups of processes
}

EndedChild RunningChild::wait() {
  if (pid_ <= 0) throw std::logic_error("RunningChild::wait() was called twice");
  EndedChild end;
  rusage usage{};
  while (::wait4(pid_, &end.status, 0, &usage) < 0)
    if (errno != EINTR) fail_at("cannot wait for a child process", errno);
  pid_ = 0;
  end.cpu_s = seconds_of(usage.ru_utime) + seconds_of(usage.ru_stime);
  end.peak_memory_mib = static_cast<double>(usage.ru_maxrss) / 1024;  // Linux states kibibytes
  return end;
}

}  // namespace psi_slam
