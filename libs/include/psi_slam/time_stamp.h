// SPDX-License-Identifier: BSD-3-Clause
/// @file
/// Time stamps: integer microseconds since the epoch of the log, usually Unix time. The benchmark identifies
/// scans by their time stamps, so the conversion to decimal seconds in text and back is exact.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace psi_slam {

/// Microseconds since the log's epoch.
using TimeUs = std::int64_t;

/// Largest magnitude of a time stamp: 3,169 years. Clocks of MRPT, ROS and GPS fit within it, and conversions
/// to their units do not overflow. Readers of files reject larger time stamps, such as milliseconds that are
/// written as seconds.
constexpr TimeUs kMostTimeUs = 100'000'000'000'000'000;

/// Returns whether a time stamp is within kMostTimeUs.
constexpr bool is_possible_time(TimeUs time_us) {
  return time_us >= -kMostTimeUs && time_us <= kMostTimeUs;
}

/// Returns the time in seconds with six decimals: "976052905.167303".
std::string format_seconds(TimeUs time_us);

/// Converts decimal seconds ("976052905.167303", "12", "1.5e9", "-0.25") to microseconds. Rounds to the
/// nearest microsecond, exactly if the text has no exponent. Returns nothing if the text is not a number, or
/// if it is beyond kMostTimeUs.
std::optional<TimeUs> parse_seconds(std::string_view text);

/// Converts microseconds to seconds.
inline double seconds(TimeUs time_us) {
  return static_cast<double>(time_us) * 1e-6;
}

}  // namespace psi_slam
