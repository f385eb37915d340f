// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <unistd.h>

#include <cstdlib>
#include <string>

namespace psi_slam {

/// Restricts ROS 2 in this process and its children to the loopback interface, and to a domain that other
/// tests do not use.
class LoopbackDomain {
 public:
  LoopbackDomain() {
    setenv("ROS_LOCALHOST_ONLY", "1", 1);
    setenv("ROS_DOMAIN_ID", std::to_string(number_).c_str(), 1);
    unsetenv("CYCLONEDDS_URI");
  }

 private:
  // Tests of ROS 2 do not run at the same time, but an earlier process may not have left the network yet.
  // Ports of domains above 101 are in the range that Linux gives to other sockets.
  int number_ = 21 + static_cast<int>(getpid() % 80);
};

}  // namespace psi_slam
