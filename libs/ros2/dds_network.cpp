// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/dds_network.h"

#include <cstdlib>
#include <sstream>

#include "base/number_text.h"
#include "live/ros2_link.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

std::uint32_t domain_of(const std::string& text) {
  const auto domain = parse_whole_number(text, kMaximumRos2Domain);
  if (!domain)
    throw UserError("ROS_DOMAIN_ID=" + text + ": expected a whole number from 0 to " +
                    std::to_string(kMaximumRos2Domain));
  return *domain;
}

enum class Range { kSubnet, kLocalhost, kOff };

Range range_of(const Environment& environment) {
  if (environment("ROS_LOCALHOST_ONLY") == "1") return Range::kLocalhost;
  const std::string range = environment("ROS_AUTOMATIC_DISCOVERY_RANGE");
  if (range.empty() || range == "SUBNET" || range == "SYSTEM_DEFAULT") return Range::kSubnet;
  if (range == "LOCALHOST") return Range::kLocalhost;
  if (range == "OFF") return Range::kOff;
  throw UserError("ROS_AUTOMATIC_DISCOVERY_RANGE=" + range +
                  ": expected SUBNET, LOCALHOST, OFF or SYSTEM_DEFAULT");
}

/// Peers that are asked by name. `peers` is separated by semicolons, as ROS_STATIC_PEERS is.
std::string peers_xml(const std::string& peers) {
  std::string xml;
  std::istringstream list(peers);
  for (std::string peer; std::getline(list, peer, ';');) {
    if (peer.find_first_of("\"<>&") != std::string::npos)
      throw UserError("ROS_STATIC_PEERS=" + peers + ": expected addresses separated by semicolons");
    if (!peer.empty()) xml += "<Peer address=\"" + peer + "\"/>";
  }
  return xml;
}

}  // namespace

std::string environment_value(const std::string& name) {
  const char* const value = std::getenv(name.c_str());
  return value != nullptr ? value : "";
}

DdsNetwork dds_network(std::optional<std::uint32_t> domain, const Environment& environment) {
  DdsNetwork network;
  const std::string stated = environment("ROS_DOMAIN_ID");
  network.domain = domain.value_or(stated.empty() ? 0 : domain_of(stated));
  if (!environment("CYCLONEDDS_URI").empty()) return network;
  const Range range = range_of(environment);
  std::string peers = peers_xml(environment("ROS_STATIC_PEERS"));
  // A map of 16 MB is sent in pieces. Larger pieces are faster on a cable, but each lost packet of a wireless
  // network would cost a whole piece.
  std::string general = "<FragmentSize>8000B</FragmentSize>";
  if (range == Range::kLocalhost) {
    general += "<Interfaces><NetworkInterface address=\"127.0.0.1\"/></Interfaces>";
    peers += "<Peer address=\"127.0.0.1\"/>";
  }
  // Without multicast, participants are found by their ports, which follow from their indices. Each asks
  // often, because one that starts later does not get what was sent before.
  const bool has_multicast = range == Range::kSubnet;
  if (!has_multicast) general += "<AllowMulticast>false</AllowMulticast>";
  const std::string index =
      has_multicast ? std::string()
                    : "<ParticipantIndex>auto</ParticipantIndex>"
                      "<MaxAutoParticipantIndex>32</MaxAutoParticipantIndex><SPDPInterval>1s</SPDPInterval>";
  network.settings = "<General>" + general + "</General><Discovery>" + index +
                     (peers.empty() ? std::string() : "<Peers>" + peers + "</Peers>") + "</Discovery>";
  return network;
}

}  // namespace psi_slam
