// SPDX-License-Identifier: BSD-3-Clause
// A pseudo-terminal, which acts as the serial port of a laser.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <stdlib.h>
#include <termios.h>
#include <unistd.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/descriptor.h"

namespace psi_slam {

/// The laser's end of a cable. The cable is plugged in while the object exists: `port` is then a symbolic
/// link to the terminal.
class PseudoTerminal {
 public:
  explicit PseudoTerminal(std::filesystem::path port)
      : port_(std::move(port)), master_(::posix_openpt(O_RDWR | O_NOCTTY)) {
    if (!master_.is_open() || ::grantpt(master_.number()) != 0 || ::unlockpt(master_.number()) != 0)
      throw std::runtime_error("no pseudo-terminal");
    const std::string terminal = ::ptsname(master_.number());
    held_open_ = Descriptor(::open(terminal.c_str(), O_RDWR | O_NOCTTY));
    termios raw = {};
    ::tcgetattr(held_open_.number(), &raw);
    ::cfmakeraw(&raw);
    ::tcsetattr(held_open_.number(), TCSANOW, &raw);
    ::fcntl(master_.number(), F_SETFL, O_NONBLOCK);
    std::filesystem::remove(port_);
    std::filesystem::create_symlink(terminal, port_);
  }
  ~PseudoTerminal() { std::filesystem::remove(port_); }
  PseudoTerminal(const PseudoTerminal&) = delete;
  PseudoTerminal& operator=(const PseudoTerminal&) = delete;

  /// Returns the next byte that the driver has sent, or nothing if none comes for `wait_ms`.
  std::optional<char> receive(int wait_ms) const {
    pollfd waited{master_.number(), POLLIN, 0};
    char c = 0;
    if (::poll(&waited, 1, wait_ms) > 0 && ::read(master_.number(), &c, 1) == 1) return c;
    return std::nullopt;
  }

  /// Sends bytes as far as the driver takes them within 10 ms. Returns how many were sent.
  std::size_t send(const std::string& bytes) const {
    std::size_t sent = 0;
    for (pollfd waited{master_.number(), POLLOUT, 0}; sent < bytes.size() && ::poll(&waited, 1, 10) > 0;) {
      const ssize_t done = ::write(master_.number(), bytes.data() + sent, bytes.size() - sent);
      if (done > 0) sent += static_cast<std::size_t>(done);
    }
    return sent;
  }

 private:
  std::filesystem::path port_;
  Descriptor master_;
  Descriptor held_open_;  // the driver's end, so that the terminal lives before the driver opens it
};

}  // namespace psi_slam
