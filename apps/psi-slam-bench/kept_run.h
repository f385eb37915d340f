// SPDX-License-Identifier: BSD-3-Clause
// What a run came to, kept in a small file, so that it is not made again as long as all that its figures
// depend on is the same.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace psi_slam {

/// What was kept in `file`, if it is there and was kept with this key.
std::optional<nlohmann::ordered_json> kept_run(const std::filesystem::path& file, const std::string& key);

/// Keeps `content`, an object, with this key. Throws SystemFailure when the file cannot be written.
void keep_run(const std::filesystem::path& file, const std::string& key,
              const nlohmann::ordered_json& content);

}  // namespace psi_slam
