// SPDX-License-Identifier: BSD-3-Clause
// Frames as bytes of a session file (format: share/doc/sessions.md): little-endian, every number to the last
// bit. Only this file knows the members of Frame. A new member must be added here, with a new
// kSessionVersion.
#pragma once

#include <cstdint>
#include <string>
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

/// Whether a pose can be that of a robot or a laser: finite and at most 10,000 km from the origin.
bool is_possible(const mrpt::math::TPose2D& pose);

/// Appends the number of frames and the frames.
void append_frames(std::string& bytes, const std::vector<Frame>& frames);

/// Reads frames of a file of this `version` and numbers them from 0. Throws MalformedBytes.
std::vector<Frame> read_frames(ByteCursor& bytes, std::uint32_t version);

}  // namespace psi_slam
