// SPDX-License-Identifier: BSD-3-Clause
#include "batch/machine_text.h"

#include <algorithm>
#include <fstream>
#include <thread>

namespace psi_slam {

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
