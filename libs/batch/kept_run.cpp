// SPDX-License-Identifier: BSD-3-Clause
#include "batch/kept_run.h"

#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "base/atomic_file.h"

namespace psi_slam {

using Json = nlohmann::ordered_json;

std::optional<Json> kept_run(const std::filesystem::path& path, const RunKey& key) {
  std::ifstream file(path, std::ios::binary);
  if (!file) return std::nullopt;
  Json json = Json::parse(std::string(std::istreambuf_iterator<char>(file), {}), nullptr, false);
  if (!json.is_object() || json.value("key", Json()) != key.text) return std::nullopt;
  const Json processes = json.value("processes", Json());
  if (!processes.is_number_integer() || processes > key.processes) return std::nullopt;
  return json;
}

void keep_run(const std::filesystem::path& path, const RunKey& key, const Json& content) {
  Json json = {{"key", key.text}, {"processes", key.processes}};
  json.update(content);
  write_text_atomically(path, json_file_text(json));
}

std::string json_file_text(const Json& json) {
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace psi_slam
