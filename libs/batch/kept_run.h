// SPDX-License-Identifier: BSD-3-Clause
// What a run came to, kept in a small file, so that it is not made again as long as all that its figures
// depend on is the same.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>

namespace psi_slam {

/// What a run is known by. Its times are those of a machine that is as busy as it was then.
struct RunKey {
  std::string text;   ///< of all that its figures depend on but how busy the machine is
  int processes = 1;  ///< runs at a time
};

/// What was kept in `file`, if it is there and of this key, and was made with no more runs at a time: times
/// that were measured on a quieter machine are as good or better, those of a busier one are none.
std::optional<nlohmann::ordered_json> kept_run(const std::filesystem::path& file, const RunKey& key);

/// Keeps `content`, an object, with this key. Throws SystemFailure when the file cannot be written.
void keep_run(const std::filesystem::path& file, const RunKey& key, const nlohmann::ordered_json& content);

}  // namespace psi_slam
