// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/dds_node.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <string_view>
#include <utility>

#include "base/text_parts.h"
#include "ros2/dds_entities.h"

namespace psi_slam {
namespace {

constexpr std::string_view kTopicPrefix = "rt";  // before the names of topics of ROS 2
constexpr std::string_view kTypeMiddle = "::msg::dds_::";

std::string dds_topic_name(const std::string& topic) {
  return std::string(kTopicPrefix) + topic;
}

/// Converts "sensor_msgs::msg::dds_::LaserScan_" to "sensor_msgs/LaserScan"; empty for other types.
std::string ros_type(std::string_view type) {
  const std::size_t middle = type.find(kTypeMiddle);
  if (middle == std::string_view::npos || type.back() != '_') return {};
  const std::string_view name = type.substr(middle + kTypeMiddle.size());
  return std::string(type.substr(0, middle)) + "/" + std::string(name.substr(0, name.size() - 1));
}

/// Calls `take` with each sample that a reader holds, which may be of any type; leaves them there.
template <class Sample, class Take>
void read_all(dds_entity_t reader, Take take) {
  constexpr std::uint32_t kMost = 10'000;
  std::vector<void*> samples(kMost, nullptr);
  std::vector<dds_sample_info_t> infos(kMost);
  const dds_return_t count =
      dds_read_mask(reader, samples.data(), infos.data(), kMost, kMost,
                    DDS_ANY_SAMPLE_STATE | DDS_ANY_VIEW_STATE | DDS_ALIVE_INSTANCE_STATE);
  for (dds_return_t i = 0; i < count; ++i) {
    const auto index = static_cast<std::size_t>(i);
    if (infos[index].valid_data) take(*static_cast<const Sample*>(samples[index]));
  }
  if (count > 0) dds_return_loan(reader, samples.data(), count);
}

}  // namespace

#define PSI_SLAM_WRITTEN_TYPE(name)               \
  template <>                                     \
  const dds_topic_descriptor_t& type_of<name>() { \
    return name##_desc;                           \
  }
PSI_SLAM_WRITTEN_TYPE(std_msgs_msg_dds__String_)
PSI_SLAM_WRITTEN_TYPE(tf2_msgs_msg_dds__TFMessage_)
PSI_SLAM_WRITTEN_TYPE(rosgraph_msgs_msg_dds__Clock_)
PSI_SLAM_WRITTEN_TYPE(sensor_msgs_msg_dds__LaserScan_)
PSI_SLAM_WRITTEN_TYPE(nav_msgs_msg_dds__Odometry_)
PSI_SLAM_WRITTEN_TYPE(nav_msgs_msg_dds__OccupancyGrid_)
PSI_SLAM_WRITTEN_TYPE(nav_msgs_msg_dds__MapMetaData_)
PSI_SLAM_WRITTEN_TYPE(nav_msgs_msg_dds__Path_)
PSI_SLAM_WRITTEN_TYPE(geometry_msgs_msg_dds__PoseWithCovarianceStamped_)
PSI_SLAM_WRITTEN_TYPE(visualization_msgs_msg_dds__MarkerArray_)
PSI_SLAM_WRITTEN_TYPE(diagnostic_msgs_msg_dds__DiagnosticArray_)
#undef PSI_SLAM_WRITTEN_TYPE

DdsNode::DdsNode(const DdsNetwork& network, std::string name, std::string name_space) : network_(network) {
  if (!network.settings.empty()) {
    const dds_entity_t domain = dds_create_domain(network.domain, network.settings.c_str());
    // Another node of this process may have opened the domain already.
    if (domain != DDS_RETCODE_PRECONDITION_NOT_MET) checked_dds(domain, "the network");
  }
  dds_set_log_mask(DDS_LC_FATAL | DDS_LC_ERROR);  // hides warnings about messages of unknown layout
  const DdsQos qos = make_dds_qos();
  constexpr std::string_view kUserData = "enclave=/;";
  dds_qset_userdata(qos.get(), kUserData.data(), kUserData.size());
  participant_ = checked_dds(dds_create_participant(network.domain, qos.get(), nullptr),
                             "domain " + std::to_string(network.domain));
  publications_ =
      checked_dds(dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr),
                  "the list of publishers");
  participants_ =
      checked_dds(dds_create_reader(participant_, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
                  "the list of participants");
  announcement_ = std::make_unique<NodeAnnouncement>(participant_, std::move(name), std::move(name_space));
}

DdsNode::~DdsNode() {
  announcement_.reset();
  dds_delete(participant_);  // deletes its readers and writers, too
}

std::vector<RosPublisher> DdsNode::publishers() const {
  dds_guid_t own{};
  dds_get_guid(participant_, &own);
  std::vector<RosPublisher> found;
  read_all<dds_builtintopic_endpoint_t>(publications_, [&](const dds_builtintopic_endpoint_t& endpoint) {
    const std::string_view name = endpoint.topic_name;
    const bool is_own = std::memcmp(endpoint.participant_key.v, own.v, sizeof own.v) == 0;
    if (is_own || !starts_with(name, dds_topic_name("/"))) return;
    found.push_back({std::string(name.substr(kTopicPrefix.size())), ros_type(endpoint.type_name),
                     id_of_guid(endpoint.key)});
  });
  return found;
}

int DdsNode::participants() const {
  int count = -1;  // without its own
  read_all<dds_builtintopic_participant_t>(participants_, [&](const auto&) { ++count; });
  return std::max(count, 0);
}

std::string DdsNode::node_of(std::uint64_t publisher) const {
  const std::string name = announcement_->node_of(publisher);
  return name.empty() ? "an unnamed node" : name;
}

dds_entity_t DdsNode::writer_of(const std::string& topic, const dds_topic_descriptor_t& type,
                                const RosQuality& quality) {
  const DdsQos qos = make_dds_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE,
                       static_cast<dds_duration_t>(quality.max_blocking_s * 1e9));
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, quality.depth);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  if (quality.is_latched) latch(qos.get(), quality.depth);
  const dds_entity_t writer = checked_dds(
      dds_create_writer(participant_, topic_of(topic, type), qos.get(), nullptr), "the topic " + topic);
  announcement_->add_writer(writer);
  return writer;
}

dds_entity_t DdsNode::topic_of(const std::string& topic, const dds_topic_descriptor_t& type) const {
  return checked_dds(dds_create_topic(participant_, &type, dds_topic_name(topic).c_str(), nullptr, nullptr),
                     "the topic " + topic);
}

std::vector<std::uint32_t> DdsNode::other_domains_in_use(std::uint32_t last) const {
  std::map<std::uint32_t, dds_entity_t> tried;
  std::vector<dds_entity_t> opened;
  for (std::uint32_t domain = 0; domain <= last; ++domain) {
    if (domain == network_.domain) continue;
    if (!network_.settings.empty()) opened.push_back(dds_create_domain(domain, network_.settings.c_str()));
    const dds_entity_t participant = dds_create_participant(domain, nullptr, nullptr);
    if (participant >= 0) tried.emplace(domain, participant);
  }
  dds_sleepfor(DDS_MSECS(1000));
  std::vector<std::uint32_t> found;
  for (const auto& [domain, participant] : tried) {
    const dds_entity_t others =
        dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr);
    int count = 0;
    read_all<dds_builtintopic_participant_t>(others, [&](const auto&) { ++count; });
    if (count > 1) found.push_back(domain);
    dds_delete(participant);
  }
  for (const dds_entity_t domain : opened)
    if (domain > 0) dds_delete(domain);
  return found;
}

}  // namespace psi_slam
