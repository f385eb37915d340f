// SPDX-License-Identifier: BSD-3-Clause
// Test helpers that play a robot which sends data, and wait for what comes of it.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <mutex>
#include <stdexcept>
#include <string>

#include "base/descriptor.h"
#include "soon.h"

namespace psi_slam {

/// Returns the port in "listening on ADDRESS:PORT"; 0 without such a text.
inline int port_in(const std::string& text) {
  const std::string before = "listening on ";
  const std::size_t at = text.find(before);
  return at == std::string::npos ? 0 : std::stoi(text.substr(text.find(':', at) + 1));
}

/// Notices of a live source, which come from its threads.
class Notices {
 public:
  void add(const std::string& notice) {
    const std::lock_guard lock(mutex_);
    text_ += notice + '\n';
  }
  std::string text() {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  int port() { return port_in(text()); }

 private:
  std::mutex mutex_;
  std::string text_;
};

/// Sends all of a text to a socket, pipe or terminal. A closed socket is an exception, not a signal.
inline void send_text(int descriptor, const std::string& text) {
  for (std::size_t sent = 0; sent < text.size();) {
    ssize_t done = ::send(descriptor, text.data() + sent, text.size() - sent, MSG_NOSIGNAL);
    if (done < 0 && errno == ENOTSOCK) done = ::write(descriptor, text.data() + sent, text.size() - sent);
    if (done < 0) throw std::runtime_error("cannot send");
    sent += static_cast<std::size_t>(done);
  }
}

/// Connects to a port of this computer.
inline Descriptor connect_to(int port) {
  Descriptor connection(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
  sockaddr_in place = {};
  place.sin_family = AF_INET;
  place.sin_port = htons(static_cast<std::uint16_t>(port));
  place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  if (::connect(connection.number(), reinterpret_cast<const sockaddr*>(&place), sizeof(place)) != 0)
    throw std::runtime_error("cannot connect to port " + std::to_string(port));
  return connection;
}

/// Lets a socket end with a reset instead of an orderly end.
inline void reset_when_closed(int descriptor) {
  const linger at_once{1, 0};
  ::setsockopt(descriptor, SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
}

}  // namespace psi_slam
