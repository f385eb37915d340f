// SPDX-License-Identifier: BSD-3-Clause
#include "batch/log_name.h"

#include <string_view>

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

}  // namespace psi_slam
