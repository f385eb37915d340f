// SPDX-License-Identifier: BSD-3-Clause
// Streams of text lines: standard input and a TCP port.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "live/line_stream.h"

namespace psi_slam {

/// Reads the descriptor of standard input, or another one that is kept open by the caller, to its end.
std::unique_ptr<LineStream> standard_input(LiveControl control, std::optional<double> idle_s,
                                           int descriptor = 0);

/// Listens on a TCP port of the IPv4 address `address` and reads what a client sends. Serves one client at a
/// time. After a lost connection the next client continues. Port 0 lets the system choose a port, which the
/// first notice names. Throws UserError if the address is invalid or the port cannot be opened.
std::unique_ptr<LineStream> tcp_input(const std::string& address, std::uint16_t port, LiveControl control,
                                      std::optional<double> idle_s);

}  // namespace psi_slam
