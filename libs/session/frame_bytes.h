// SPDX-License-Identifier: BSD-3-Clause
// Frames as they stand in a session file, see share/doc/sessions.md: little-endian, every number to the last
// bit. This is the one place that knows what a frame holds: who adds something to Frame adds it here, and
// raises kSessionVersion.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "base/byte_cursor.h"
#include "psi_slam/frame.h"

namespace psi_slam {

/// Adds the bytes of a number behind `bytes`.
template <class Number>
void append_number(std::string& bytes, Number number) {
  char raw[sizeof(Number)];
  std::memcpy(raw, &number, sizeof raw);
  if (__BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__)
    for (std::size_t i = 0; i < sizeof raw / 2; ++i) std::swap(raw[i], raw[sizeof raw - 1 - i]);
  bytes.append(raw, sizeof raw);
}

/// Whether a pose can be one of a robot or a laser: finite, and no farther than 10,000 km from where it is
/// seen.
bool is_possible(const mrpt::math::TPose2D& pose);

/// With their count before them.
void append_frames(std::string& bytes, const std::vector<Frame>& frames);

/// Numbers them from 0. Throws MalformedBytes where they are no such frames. `version` is the file's.
std::vector<Frame> read_frames(ByteCursor& bytes, std::uint32_t version);

}  // namespace psi_slam
