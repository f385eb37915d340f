// SPDX-License-Identifier: BSD-3-Clause
// Frames in sessions and journals: little-endian bytes, every number to the last bit. share/doc/sessions.md
// describes the format. If Frame gets a new member, frame_bytes.cpp must write and read it, with a new
// kSessionVersion.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "base/byte_cursor.h"
#include "psi_slam/frame.h"

namespace psi_slam {

/// Appends the bytes of a number to `bytes`.
template <class Number>
void append_number(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof raw);
  if (__BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__)
    for (std::size_t i = 0; i < sizeof raw / 2; ++i) std::swap(raw[i], raw[sizeof raw - 1 - i]);
  bytes.append(raw, sizeof raw);
}

/// Serialises frames one after the other. Writes the description of a sensor only with the first frame and
/// when it changes.
class FrameWriter {
 public:
  /// Appends the bytes of a frame, without its number.
  void append(std::string& bytes, const Frame& frame);

 private:
  /// The last described sensors. Key 0 is the frame's own scan, key i + 1 is companion i.
  std::map<std::size_t, std::string> sensors_;
};

/// Reads the frames of a FrameWriter, in the same order.
class FrameReader {
 public:
  /// Reads a frame, without its number. Throws MalformedBytes if the bytes are damaged.
  Frame read(ByteCursor& bytes);

 private:
  std::vector<CompanionScan> read_companions(ByteCursor& bytes, std::size_t first_laser);

  std::map<std::size_t, LaserScan> sensors_;  ///< see FrameWriter
};

}  // namespace psi_slam
