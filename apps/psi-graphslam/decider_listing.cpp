// SPDX-License-Identifier: BSD-3-Clause
#include "decider_listing.h"

namespace psi_slam {

std::string decider_listing(const std::string& heading, const std::vector<DeciderDescription>& deciders) {
  std::string text = heading + "\n";
  for (const DeciderDescription& decider : deciders) {
    text += "  " + decider.name + (decider.is_ours ? " (psi-slam)" : " (MRPT)") + '\n';
    text += "      " + decider.description + '\n';
    if (!decider.rawlog_format.empty()) text += "      rawlog format: " + decider.rawlog_format + '\n';
    for (const std::string& observation : decider.observations) text += "      uses " + observation + '\n';
  }
  return text;
}

}  // namespace psi_slam
