// SPDX-License-Identifier: BSD-3-Clause
// Names of what is being written: ".partial-PID", or ".partial-PID-NAME".
#pragma once

#include <unistd.h>

#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "base/text_parts.h"

namespace psi_slam {

inline constexpr std::string_view kPartial = ".partial-";

/// Of this process.
inline std::string partial_name() {
  return std::string(kPartial) + std::to_string(::getpid());
}
inline std::string partial_name(const std::string& name) {
  return partial_name() + '-' + name;
}

/// The process that writes under this name; none for other names.
inline std::optional<pid_t> writer_of(std::string_view name) {
  if (!starts_with(name, kPartial)) return std::nullopt;
  name.remove_prefix(kPartial.size());
  pid_t pid = 0;
  const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), pid);
  const bool whole = end == name.data() + name.size() || *end == '-';
  return error == std::errc() && whole && pid > 0 ? std::optional(pid) : std::nullopt;
}

}  // namespace psi_slam
