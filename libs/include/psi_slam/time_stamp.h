// SPDX-License-Identifier: BSD-3-Clause
// Time stamps are whole microseconds since the log's own epoch (usually Unix time), as the benchmark is keyed by them;
// text carries them as decimal seconds, and the way there and back is exact.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace psi_slam {

/// Microseconds since the log's epoch.
using TimeUs = std::int64_t;

/// "976052905.167303": seconds with six decimals.
std::string format_seconds(TimeUs time_us);

/// Reads decimal seconds ("976052905.167303", "12", "1.5e9", "-0.25") to the nearest microsecond, without going
/// through a double unless there is an exponent. Empty when the text is not a finite number of that range.
std::optional<TimeUs> parse_seconds(std::string_view text);

inline double seconds(TimeUs time_us) { return static_cast<double>(time_us) * 1e-6; }

}  // namespace psi_slam
