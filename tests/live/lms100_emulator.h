// SPDX-License-Identifier: BSD-3-Clause
// A SICK LMS100 on a TCP port that speaks SOPAS telegrams, as far as mrpt::hwdrivers::CLMS100Eth needs it.
#pragma once

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

#include <atomic>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "base/descriptor.h"

namespace psi_slam {

/// The laser answers each request for a scan with its next message: ranges in metres, or a raw telegram.
/// After the last one it does not answer. It begins with the first one again for each connection. It listens
/// while the object exists.
class Lms100Emulator {
 public:
  struct Message {
    std::vector<float> ranges_m;
    std::string raw;  ///< sent as it is, unless it is empty
  };

  /// Listens on `port`; 0 lets the system choose one.
  explicit Lms100Emulator(std::vector<Message> messages, std::uint16_t port = 0)
      : messages_(std::move(messages)), listener_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    const int yes = 1;
    ::setsockopt(listener_.number(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
    sockaddr_in place = {};
    place.sin_family = AF_INET;
    place.sin_port = htons(port);
    place.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(place);
    if (::bind(listener_.number(), reinterpret_cast<const sockaddr*>(&place), size) != 0 ||
        ::listen(listener_.number(), 1) != 0)
      throw std::runtime_error("cannot listen");
    ::getsockname(listener_.number(), reinterpret_cast<sockaddr*>(&place), &size);
    port_ = ntohs(place.sin_port);
    thread_ = std::thread([this] { run(); });
  }
  ~Lms100Emulator() {
    off_ = true;
    thread_.join();
  }
  Lms100Emulator(const Lms100Emulator&) = delete;
  Lms100Emulator& operator=(const Lms100Emulator&) = delete;

  std::uint16_t port() const { return port_; }
  std::size_t played() const { return played_; }

 private:
  static std::string telegram(const std::string& text) { return '\x02' + text + '\x03'; }

  /// A reply of 100 bytes, which the driver takes at once instead of waiting for more.
  static std::string padded(std::string reply) {
    reply.resize(98, ' ');
    return telegram(reply);
  }

  static std::string scan_reply(const std::vector<float>& ranges_m) {
    char number[16];
    std::string text =
        "sRA LMDscandata 1 1 89A27F 0 0 3B5 3B6 2A1B 2A1C 0 0 7 0 0 1388 168 0 1 DIST1 3F800000 00000000 "
        "FFF92230 1388 ";
    std::snprintf(number, sizeof number, "%zX", ranges_m.size());
    text += number;
    for (const float range_m : ranges_m) {
      std::snprintf(number, sizeof number, " %lX", std::lround(range_m * 1000));
      text += number;
    }
    return telegram(text + " 0 0 0 0 0 0");
  }

  std::string reply_to(const std::string& request) {
    if (request == "sRN LMDscandata") {
      if (played_ == messages_.size()) return "";
      const Message& message = messages_[played_++];
      return message.raw.empty() ? scan_reply(message.ranges_m) : message.raw;
    }
    if (request == "sRN STlms") return padded("sRA STlms 7 0");
    return padded("sAN " + request.substr(4, request.find(' ', 4) - 4) + " 0");
  }

  void run() {
    std::string received;
    Descriptor client;
    while (!off_) {
      pollfd waited{client.is_open() ? client.number() : listener_.number(), POLLIN, 0};
      if (::poll(&waited, 1, 5) <= 0) continue;
      char c = 0;
      if (!client.is_open()) {
        client = Descriptor(::accept(listener_.number(), nullptr, nullptr));
        received.clear();
        played_ = 0;
      } else if (::read(client.number(), &c, 1) != 1) {
        client.close();
      } else if (c == '\x03') {
        const std::string reply = reply_to(received.substr(1));
        ::send(client.number(), reply.data(), reply.size(), MSG_NOSIGNAL);
        received.clear();
      } else {
        received += c;
      }
    }
  }

  std::vector<Message> messages_;
  Descriptor listener_;
  std::uint16_t port_ = 0;
  std::atomic<std::size_t> played_ = 0;
  std::atomic<bool> off_ = false;
  std::thread thread_;
};

}  // namespace psi_slam
