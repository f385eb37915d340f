// SPDX-License-Identifier: BSD-3-Clause
#include "batch/kept_run.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <string_view>
#include <thread>

#include "base/atomic_file.h"
#include "base/number_text.h"

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

std::optional<std::string> log_name_of(const std::string& file) {
  const std::filesystem::path path(file);
  for (const char* packed : {".gz", ".bz2", ".xz", ".lz4", ".zst", ".zstd"})
    if (path.extension() == packed) return log_name_of(path.stem().string());
  for (const char* ending : {".clf", ".log", ".rawlog", ".bag", ".db3", ".mcap"})
    if (path.extension() == ending && path.has_stem()) return path.stem().string();
  return std::nullopt;
}

std::string machine_text() {
  std::string model = "unknown processor";
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.rfind("model name", 0) != 0) continue;
    const std::size_t value = line.find(": ");
    if (value != std::string::npos) model = line.substr(value + 2);
    break;
  }
  const unsigned processors = std::max(1U, std::thread::hardware_concurrency());
  return model + ", " + counted(processors, "processor");
}

}  // namespace psi_slam
