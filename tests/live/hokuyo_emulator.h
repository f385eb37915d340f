// SPDX-License-Identifier: BSD-3-Clause
// A Hokuyo laser on a pseudo-terminal that speaks SCIP 2.0, as far as mrpt::hwdrivers::CHokuyoURG needs it.
#pragma once

#include <atomic>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "pseudo_terminal.h"

namespace psi_slam {

/// The laser plays its messages in turn: scans as ranges in metres, or raw bytes. It is silent after the last
/// one. It begins with the first one when it is started, which the driver does twice in a row. The
/// cable is plugged in while the object exists: `port` is then a symbolic link to the terminal.
class HokuyoEmulator {
 public:
  static constexpr std::size_t kBeams = 361;  ///< one each half degree, counter-clockwise

  struct Message {
    std::vector<float> ranges_m;
    std::string raw;  ///< sent as it is, unless it is empty
  };

  HokuyoEmulator(std::filesystem::path port, std::vector<Message> messages)
      : messages_(std::move(messages)), terminal_(std::move(port)), thread_([this] { run(); }) {}
  ~HokuyoEmulator() {
    unplugged_ = true;
    thread_.join();
  }
  HokuyoEmulator(const HokuyoEmulator&) = delete;
  HokuyoEmulator& operator=(const HokuyoEmulator&) = delete;

  /// Number of messages that were sent.
  std::size_t played() const { return played_; }

 private:
  static std::string with_sum(const std::string& text) {
    unsigned sum = 0;
    for (const char c : text) sum += static_cast<unsigned char>(c);
    return text + static_cast<char>((sum & 0x3FU) + 0x30U) + '\n';
  }

  static std::string encoded(std::uint32_t value, int characters) {
    std::string text;
    for (int i = characters - 1; i >= 0; --i) text += static_cast<char>(((value >> (6 * i)) & 0x3FU) + 0x30U);
    return text;
  }

  std::string scan_reply(const std::vector<float>& ranges_m) const {
    constexpr std::size_t kBlock = 64;
    std::string data;
    for (const float range_m : ranges_m)
      data += encoded(static_cast<std::uint32_t>(std::lround(range_m * 1000)), 3);
    std::string reply = streamed_ + with_sum("99") + with_sum(encoded(0, 4));
    for (std::size_t at = 0; at < data.size(); at += kBlock) reply += with_sum(data.substr(at, kBlock));
    return reply + '\n';
  }

  void send(std::string text) const {
    while (!text.empty() && !unplugged_) text.erase(0, terminal_.send(text));
  }

  void answer(const std::string& command) {
    std::string reply = command + with_sum("00");
    if (command == "PP\n")
      for (const char* fact : {"MODL:EMULATOR;", "DMIN:20;", "DMAX:30000;", "ARES:720;", "AMIN:0;",
                               "AMAX:360;", "AFRT:180;", "SCAN:600;"})
        reply += with_sum(fact);
    if (command == "VV\n") reply += with_sum("VEND:psi-slam;");
    if (command == "QT\n") streamed_.clear();
    if (command.substr(0, 2) == "MD") {
      streamed_ = command;
      played_ = 0;
    }
    send(reply + '\n');
  }

  void run() {
    std::string received;
    while (!unplugged_) {
      const bool is_playing = !streamed_.empty() && played_ < messages_.size();
      if (const std::optional<char> c = terminal_.receive(is_playing ? 0 : 5)) {
        received += *c;
        if (*c == '\n') answer(std::exchange(received, ""));
      } else if (is_playing) {
        const Message& message = messages_[played_];
        send(message.raw.empty() ? scan_reply(message.ranges_m) : message.raw);
        ++played_;
      }
    }
  }

  std::vector<Message> messages_;
  PseudoTerminal terminal_;
  std::string streamed_;  // command whose scans are sent
  std::atomic<std::size_t> played_ = 0;
  std::atomic<bool> unplugged_ = false;
  std::thread thread_;
};

}  // namespace psi_slam
