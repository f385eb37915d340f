// SPDX-License-Identifier: BSD-3-Clause
// Which part of the network psi-slam speaks to, by the environment variables of ROS 2.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace psi_slam {

/// A DDS domain and how its participants find each other.
struct DdsNetwork {
  std::uint32_t domain = 0;
  /// Settings of Cyclone DDS as XML. Empty: those of CYCLONEDDS_URI, which the user has set.
  std::string settings;
};

/// Returns the value of an environment variable; empty if it is not set.
using Environment = std::function<std::string(const std::string& name)>;

/// The environment of this process.
std::string environment_value(const std::string& name);

/// Reads ROS_DOMAIN_ID, ROS_LOCALHOST_ONLY, ROS_AUTOMATIC_DISCOVERY_RANGE, ROS_STATIC_PEERS and
/// CYCLONEDDS_URI, as ROS 2 does. `domain` overrides ROS_DOMAIN_ID. With ROS_LOCALHOST_ONLY=1 or the range
/// LOCALHOST, all traffic stays on the loopback interface. Throws UserError for invalid values.
DdsNetwork dds_network(std::optional<std::uint32_t> domain,
                       const Environment& environment = environment_value);

}  // namespace psi_slam
