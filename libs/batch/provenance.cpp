// SPDX-License-Identifier: BSD-3-Clause
#include "batch/provenance.h"

#include <algorithm>
#include <fstream>
#include <string_view>
#include <thread>

namespace psi_slam {

std::optional<std::string> log_name_of(const std::string& file) {
  for (const char* ending :
       {".clf", ".log", ".rawlog", ".clf.gz", ".log.gz", ".rawlog.gz", ".bag", ".db3", ".mcap"}) {
    const std::string_view end = ending;
    if (file.size() > end.size() && file.compare(file.size() - end.size(), end.size(), end) == 0)
      return file.substr(0, file.size() - end.size());
  }
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
  return model + ", " + std::to_string(processors) + (processors == 1 ? " processor" : " processors");
}

}  // namespace psi_slam
