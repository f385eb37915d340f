// SPDX-License-Identifier: BSD-3-Clause
#include "live/line_streams.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <array>
#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

#include "base/descriptor.h"
#include "base/text_parts.h"
#include "frames/log_format.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostBytes = std::size_t{64} * 1024;  // bytes received at once

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
  std::array<char, kMostBytes> room{};
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

class GrowingFile : public LineStream {
 public:
  GrowingFile(const fs::path& file, LiveControl control, std::optional<double> idle_s)
      : LineStream(file, std::move(control), idle_s), file_(::open(file.c_str(), O_RDONLY | O_CLOEXEC)) {
    if (!file_.is_open()) throw UserError("cannot read " + file.string() + ": " + std::strerror(errno));
  }

 protected:
  Received receive(std::string& bytes) override {
    const ssize_t got = append_from(file_.number(), bytes);
    if (got < 0 && !is_temporary(errno))
      throw UserError("cannot read " + path().string() + ": " + std::strerror(errno));
    if (got > 0) {
      size_ += got;
      return Received::kBytes;
    }
    struct stat state = {};
    if (::fstat(file_.number(), &state) == 0 && state.st_size < size_)
      throw UserError(path().string() +
                      " became shorter while it was followed, expected a log that grows. Follow the new log");
    ::poll(nullptr, 0, kWait_ms);
    return Received::kNothing;
  }

 private:
  Descriptor file_;
  off_t size_ = 0;
};

/// Throws UserError if a file is not one of lines that can grow. An empty file is one.
void check_growing_lines(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw UserError(file.string() + " does not exist, expected a log that is being recorded. Check the path");
  const std::string remedy =
      " cannot be followed, expected a plain CARMEN log. Record CARMEN lines, or map the log when it is "
      "complete";
  if (fs::is_directory(file, ignored)) throw UserError(file.string() + " is a folder and" + remedy);
  // Looking at the first bytes of a pipe would take them from the stream.
  if (!fs::is_regular_file(file, ignored))
    throw UserError(file.string() +
                    " is no regular file, expected a log that is being recorded. Pipe it to "
                    "--stdin");
  std::array<char, 4> head{};
  const Descriptor opened(::open(file.c_str(), O_RDONLY | O_CLOEXEC));
  const ssize_t got = ::read(opened.number(), head.data(), head.size());
  const std::string_view begin(head.data(), got > 0 ? static_cast<std::size_t>(got) : 0);
  if (starts_with(begin, "\x1f\x8b") || starts_with(begin, "\x28\xb5\x2f\xfd"))
    throw UserError(file.string() + " is compressed and" + remedy);
  if (begin.empty()) return;
  LogFormat format = LogFormat::kCarmen;
  try {
    format = detect_log_format(file);
  } catch (const UserError&) {  // its first lines may be comments
  }
  if (format != LogFormat::kCarmen)
    throw UserError(file.string() + " is a " + std::string(name_of(format)) + " and" + remedy);
}

}  // namespace

std::unique_ptr<LineStream> standard_input(LiveControl control, std::optional<double> idle_s,
                                           int descriptor) {
  return std::make_unique<StandardInput>(std::move(control), idle_s, descriptor);
}

std::unique_ptr<LineStream> tcp_input(const std::string& address, std::uint16_t port, LiveControl control,
                                      std::optional<double> idle_s) {
  return std::make_unique<TcpInput>(address, port, std::move(control), idle_s);
}

std::unique_ptr<LineStream> growing_file(const fs::path& file, LiveControl control,
                                         std::optional<double> idle_s) {
  check_growing_lines(file);
  return std::make_unique<GrowingFile>(file, std::move(control), idle_s);
}

}  // namespace psi_slam
