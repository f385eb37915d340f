// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/dds_network.h"

#include <gmock/gmock.h>

#include <map>
#include <string>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;
using testing::Not;

Environment environment(std::map<std::string, std::string> values) {
  return [values = std::move(values)](const std::string& name) {
    const auto found = values.find(name);
    return found == values.end() ? std::string() : found->second;
  };
}

TEST(DdsNetwork, UsesDomain0AndMulticastUnlessTheEnvironmentSaysOtherwise) {
  const DdsNetwork network = dds_network(std::nullopt, environment({}));
  EXPECT_EQ(network.domain, 0);
  EXPECT_THAT(network.settings, Not(HasSubstr("AllowMulticast")));
  EXPECT_THAT(network.settings, Not(HasSubstr("Peer")));
}

TEST(DdsNetwork, TakesTheDomainOfTheEnvironmentUnlessOneIsGiven) {
  const Environment with_domain = environment({{"ROS_DOMAIN_ID", "42"}});
  EXPECT_EQ(dds_network(std::nullopt, with_domain).domain, 42);
  EXPECT_EQ(dds_network(7, with_domain).domain, 7);
}

TEST(DdsNetwork, StaysOnLoopbackIfToldSoByEitherVariable) {
  for (const auto& [name, value] : std::map<std::string, std::string>{
           {"ROS_LOCALHOST_ONLY", "1"}, {"ROS_AUTOMATIC_DISCOVERY_RANGE", "LOCALHOST"}}) {
    const DdsNetwork network = dds_network(std::nullopt, environment({{name, value}}));
    EXPECT_THAT(network.settings, HasSubstr(R"(<NetworkInterface address="127.0.0.1"/>)")) << name;
    EXPECT_THAT(network.settings, HasSubstr("<AllowMulticast>false</AllowMulticast>")) << name;
  }
}

TEST(DdsNetwork, AsksStaticPeers) {
  const DdsNetwork network = dds_network(std::nullopt, environment({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "OFF"},
                                                                    {"ROS_STATIC_PEERS", "10.0.0.5;robot"}}));
  EXPECT_THAT(network.settings, HasSubstr(R"(<Peer address="10.0.0.5"/><Peer address="robot"/>)"));
  EXPECT_THAT(network.settings, HasSubstr("<AllowMulticast>false</AllowMulticast>"));
}

TEST(DdsNetwork, LeavesEverythingToTheSettingsOfTheUser) {
  const DdsNetwork network = dds_network(
      std::nullopt, environment({{"CYCLONEDDS_URI", "file:///etc/dds.xml"}, {"ROS_LOCALHOST_ONLY", "1"}}));
  EXPECT_EQ(network.settings, "");
}

TEST(DdsNetwork, NamesTheVariableThatIsWrong) {
  const auto error_of = [](std::map<std::string, std::string> values) -> std::string {
    try {
      dds_network(std::nullopt, environment(std::move(values)));
    } catch (const UserError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_THAT(error_of({{"ROS_DOMAIN_ID", "233"}}), HasSubstr("ROS_DOMAIN_ID=233"));
  EXPECT_THAT(error_of({{"ROS_DOMAIN_ID", "lab"}}), HasSubstr("ROS_DOMAIN_ID=lab"));
  EXPECT_THAT(error_of({{"ROS_AUTOMATIC_DISCOVERY_RANGE", "WORLD"}}),
              HasSubstr("expected SUBNET, LOCALHOST"));
  EXPECT_THAT(error_of({{"ROS_STATIC_PEERS", "\"/><x"}}), HasSubstr("ROS_STATIC_PEERS"));
}

}  // namespace
}  // namespace psi_slam
