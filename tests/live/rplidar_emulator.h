// SPDX-License-Identifier: BSD-3-Clause
// An RPLIDAR A1 on a pseudo-terminal that speaks the protocol of SLAMTEC, as far as
// mrpt::hwdrivers::CRoboPeakLidar needs it. Its firmware is older than the express scans.
#pragma once

#include <mrpt/version.h>

#include <algorithm>
#include <atomic>
#include <chrono>
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

/// The laser plays its messages in turn, one each 50 ms: scans as ranges in metres, or raw bytes. It repeats
/// the last one. If the driver starts it again, it continues with the next one. The cable is plugged in while
/// the object exists.
class RplidarEmulator {
 public:
  /// The driver since MRPT 2.9 has another library of SLAMTEC. It gets no scans from the emulator.
  static constexpr bool kDriverUnderstands = MRPT_VERSION < 0x292;
  static constexpr const char* kNotUnderstood = "the emulator does not speak to the driver of this MRPT";

  static constexpr std::size_t kBeams = 360;  ///< one each degree, clockwise from the laser's 0 degrees

  struct Message {
    std::vector<float> ranges_m;  ///< 0: no return
    std::string raw;              ///< sent as it is, unless it is empty
  };

  RplidarEmulator(std::filesystem::path port, std::vector<Message> messages)
      : messages_(std::move(messages)), terminal_(std::move(port)), thread_([this] { run(); }) {}
  ~RplidarEmulator() {
    unplugged_ = true;
    thread_.join();
  }
  RplidarEmulator(const RplidarEmulator&) = delete;
  RplidarEmulator& operator=(const RplidarEmulator&) = delete;

 private:
  using Clock = std::chrono::steady_clock;

  static constexpr char kStart = '\xA5';

  static std::string packed(std::uint32_t value, int bytes) {
    std::string text;
    for (int i = 0; i < bytes; ++i) text += static_cast<char>(value >> (8 * i));
    return text;
  }

  /// Begins a reply of `bytes`, which the laser repeats if `repeats`.
  static std::string descriptor(std::uint32_t bytes, bool repeats, char type) {
    return std::string{kStart, '\x5A'} + packed(bytes | (repeats ? 0x40000000U : 0U), 4) + type;
  }

  /// Five bytes for each beam: start of a turn and its complement, check bit and angle, range.
  static std::string scan_reply(const std::vector<float>& ranges_m) {
    std::string reply;
    for (std::size_t i = 0; i < ranges_m.size(); ++i) {
      const std::uint32_t quality = ranges_m[i] > 0 ? 15 : 0;
      const auto angle = static_cast<std::uint32_t>(i * 360 * 64 / ranges_m.size());
      reply += packed((quality << 2) | (i == 0 ? 1U : 2U), 1) + packed((angle << 1) | 1U, 2) +
               packed(static_cast<std::uint32_t>(std::lround(ranges_m[i] * 4000)), 2);
    }
    return reply;
  }

  void send(std::string bytes) const {
    while (!bytes.empty() && !unplugged_) bytes.erase(0, terminal_.send(bytes));
  }

  void answer(char command) {
    constexpr char kStop = '\x25', kReset = '\x40', kScan = '\x20', kInfo = '\x50', kHealth = '\x52',
                   kAccessories = '\xFF';
    if (command == kStop || command == kReset) is_playing_ = false;
    if (command == kInfo)  // model, minor and major version of the firmware, hardware, serial number
      send(descriptor(20, false, '\x04') + std::string{'\x18', '\x10', '\x01', '\x05'} +
           std::string(16, 'S'));
    if (command == kHealth) send(descriptor(3, false, '\x06') + std::string(3, '\0'));
    if (command == kAccessories) send(descriptor(4, false, '\xFF') + std::string(4, '\0'));
    if (command != kScan) return;
    send(descriptor(5, true, '\x81'));
    is_playing_ = true;
  }

  /// Takes a byte of a request. Requests with the highest bit have a length, so many bytes and a checksum.
  void take(char c) {
    request_ += c;
    if (request_.front() != kStart) request_.clear();
    if (request_.size() < 2) return;
    const bool has_data = (static_cast<unsigned char>(request_[1]) & 0x80U) != 0;
    const std::size_t needed = !has_data             ? 2
                               : request_.size() < 3 ? 3
                                                     : 4 + static_cast<unsigned char>(request_[2]);
    if (request_.size() < needed) return;
    answer(request_[1]);
    request_.clear();
  }

  void run() {
    Clock::time_point next = Clock::now();
    while (!unplugged_) {
      if (const std::optional<char> c = terminal_.receive(2)) take(*c);
      if (!is_playing_ || Clock::now() < next) continue;
      const Message& message = messages_[std::min(played_++, messages_.size() - 1)];
      send(message.raw.empty() ? scan_reply(message.ranges_m) : message.raw);
      next = Clock::now() + std::chrono::milliseconds(50);
    }
  }

  std::vector<Message> messages_;
  PseudoTerminal terminal_;
  std::string request_;
  bool is_playing_ = false;
  std::size_t played_ = 0;  // messages
  std::atomic<bool> unplugged_ = false;
  std::thread thread_;
};

}  // namespace psi_slam
