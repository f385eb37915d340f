// SPDX-License-Identifier: BSD-3-Clause
#include "live/line_streams.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "base/descriptor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

bool is_temporary(int error) {
  return error == EINTR || error == EAGAIN || error == EWOULDBLOCK;
}

/// Waits until a descriptor can be read or has ended. Returns false if that takes longer than `wait_ms`.
bool is_ready(int descriptor, int wait_ms) {
  pollfd waited{descriptor, POLLIN, 0};
  return ::poll(&waited, 1, wait_ms) > 0;
}

/// Appends what a descriptor holds. Returns what read() returned.
ssize_t append_from(int descriptor, std::string& bytes) {
  std::array<char, LineStream::kMostBytes> room{};
  const ssize_t got = ::read(descriptor, room.data(), room.size());
  if (got > 0) bytes.append(room.data(), static_cast<std::size_t>(got));
  return got;
}

class StandardInput : public LineStream {
 public:
  StandardInput(LiveControl control, std::optional<double> idle_s, int descriptor)
      : LineStream("standard input", std::move(control), idle_s), descriptor_(descriptor) {}

 protected:
  Received receive(std::string& bytes) override {
    if (!is_ready(descriptor_, kWait_ms)) return Received::kNothing;
    const ssize_t got = append_from(descriptor_, bytes);
    if (got > 0) return Received::kBytes;
    if (got == 0) return Received::kEnd;
    if (is_temporary(errno)) return Received::kNothing;
    throw UserError("cannot read standard input: " + std::string(std::strerror(errno)));
  }

 private:
  int descriptor_;
};

class TcpInput : public LineStream {
 public:
  TcpInput(const std::string& address, std::uint16_t port, LiveControl control, std::optional<double> idle_s)
      : LineStream("TCP port " + std::to_string(port), std::move(control), idle_s) {
    sockaddr_in place = {};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    if (::inet_pton(AF_INET, address.c_str(), &place.sin_addr) != 1)
      throw UserError("--bind " + address + ": expected an IPv4 address of this computer, such as 127.0.0.1");
    const auto fail = [&](const std::string& remedy) {
      const std::string reason = std::strerror(errno);
      throw UserError("cannot listen on port " + std::to_string(port) + " of " + address + ": " + reason +
                      ". " + remedy);
    };
    listener_ = Descriptor(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0));
    if (!listener_.is_open()) fail("Close other programs");
    const int yes = 1;
    ::setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    const auto* const any_place = reinterpret_cast<const sockaddr*>(&place);
    if (::bind(listener_.number(), any_place, sizeof(place)) != 0 || ::listen(listener_.number(), 1) != 0)
      fail("Choose another port with --tcp, or an address of this computer with --bind");
    socklen_t size = sizeof(place);
    ::getsockname(listener_.number(), reinterpret_cast<sockaddr*>(&place), &size);
    notify("listening on " + address + ":" + std::to_string(ntohs(place.sin_port)));
  }

 protected:
  Received receive(std::string& bytes) override {
    if (!client_.is_open()) {
      if (is_ready(listener_.number(), kWait_ms)) accept();
      return Received::kNothing;
    }
    if (!is_ready(client_.number(), kWait_ms)) return Received::kNothing;
    const ssize_t got = append_from(client_.number(), bytes);
    if (got > 0) return Received::kBytes;
    if (got < 0 && is_temporary(errno)) return Received::kNothing;
    client_.close();
    notify("the sender disconnected, waiting for another one");
    return Received::kLost;
  }

 private:
  void accept() {
    sockaddr_in sender = {};
    socklen_t size = sizeof(sender);
    client_ = Descriptor(::accept4(listener_.number(), reinterpret_cast<sockaddr*>(&sender), &size,
                                   SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (!client_.is_open()) {
      ::poll(nullptr, 0, kWait_ms);  // the failure may last, such as too many open files
      return;
    }
    find_cut_cables();
    std::array<char, INET_ADDRSTRLEN> address{};
    ::inet_ntop(AF_INET, &sender.sin_addr, address.data(), address.size());
    notify("connected to the sender at " + std::string(address.data()));
  }

  /// Lets the system close a connection that has been dead for about 10 s, so that the sender can connect
  /// again.
  void find_cut_cables() const {
    const auto set = [&](int level, int option, int value) {
      ::setsockopt(client_.number(), level, option, &value, sizeof(value));
    };
    set(SOL_SOCKET, SO_KEEPALIVE, 1);
    set(IPPROTO_TCP, TCP_KEEPIDLE, 4);
    set(IPPROTO_TCP, TCP_KEEPINTVL, 2);
    set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  }

  Descriptor listener_;
  Descriptor client_;
};

}  // namespace

std::unique_ptr<LineStream> standard_input(LiveControl control, std::optional<double> idle_s,
                                           int descriptor) {
  return std::make_unique<StandardInput>(std::move(control), idle_s, descriptor);
}

std::unique_ptr<LineStream> tcp_input(const std::string& address, std::uint16_t port, LiveControl control,
                                      std::optional<double> idle_s) {
  return std::make_unique<TcpInput>(address, port, std::move(control), idle_s);
}

}  // namespace psi_slam
