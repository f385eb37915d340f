// SPDX-License-Identifier: BSD-3-Clause
// Results appear whole or not at all: they are written beside their final name and renamed when complete.
#pragma once

#include <filesystem>
#include <functional>
#include <string_view>

namespace psi_slam {

/// Calls `write(temporary_path)`; when it returns, renames that file to `path`. The temporary file stands in the same
/// folder and its name ends like `path`, so that writers which choose a format by extension still do. If `write`
/// throws or leaves no file behind, nothing stands at `path` that did not stand there before, and the temporary file
/// is gone. Throws SystemFailure naming `path` when it cannot be written.
void write_atomically(const std::filesystem::path& path,
                      const std::function<void(const std::filesystem::path& temporary_path)>& write);

/// The same for a text or bytes already in memory.
void write_text_atomically(const std::filesystem::path& path, std::string_view text);

}  // namespace psi_slam
