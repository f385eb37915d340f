// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/dds_inbox.h"

#include <dds/ddsi/ddsi_serdata.h>

#include <algorithm>
#include <stdexcept>

#include "logs/rosbag/ros_messages.h"
#include "ros2/dds_entities.h"
#include "ros2/node_announcement.h"
#include "ros2_messages.h"

namespace psi_slam {
namespace {

constexpr std::int32_t kMostSamples = 20'000;  // that wait in a reader

/// The types that can be received.
const dds_topic_descriptor_t& type_to_read(const std::string& type) {
  static const std::map<std::string, const dds_topic_descriptor_t*> types = {
      {kRosLaserScan, &sensor_msgs_msg_dds__LaserScan__desc},
      {kRosMultiEchoScan, &sensor_msgs_msg_dds__MultiEchoLaserScan__desc},
      {kRosPointCloud, &sensor_msgs_msg_dds__PointCloud2__desc},
      {kRosImu, &sensor_msgs_msg_dds__Imu__desc},
      {kRosOdometry, &nav_msgs_msg_dds__Odometry__desc},
      {kRosTransforms, &tf2_msgs_msg_dds__TFMessage__desc},
      {"rosgraph_msgs/Clock", &rosgraph_msgs_msg_dds__Clock__desc},
      {"std_msgs/String", &std_msgs_msg_dds__String__desc},
      {"geometry_msgs/PoseWithCovarianceStamped", &geometry_msgs_msg_dds__PoseWithCovarianceStamped__desc}};
  const auto found = types.find(type);
  if (found == types.end()) throw std::invalid_argument("DdsInbox: unknown type " + type);
  return *found->second;
}

}  // namespace

DdsInbox::DdsInbox(DdsNode& node)
    : node_(node), waitset_(checked_dds(dds_create_waitset(node.participant_), "a waitset")) {}

DdsInbox::~DdsInbox() {
  for (const auto& [topic, reader] : readers_) close(reader);
  dds_delete(waitset_);
}

void DdsInbox::close(const Reader& reader) {
  node_.announcement_->remove_reader(reader.entity);
  dds_waitset_detach(waitset_, reader.entity);
  dds_delete(reader.entity);
}

void DdsInbox::subscribe(const std::string& topic, const std::string& type, RosReading reading) {
  if (readers_.count(topic) > 0) return;
  const DdsQos qos = make_dds_qos();
  dds_qset_reliability(
      qos.get(), reading == RosReading::kBestEffort ? DDS_RELIABILITY_BEST_EFFORT : DDS_RELIABILITY_RELIABLE,
      DDS_SECS(1));
  dds_qset_durability(
      qos.get(), reading == RosReading::kLatched ? DDS_DURABILITY_TRANSIENT_LOCAL : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, DDS_LENGTH_UNLIMITED);
  dds_qset_resource_limits(qos.get(), kMostSamples, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  Reader reader;
  reader.topic = {topic, type, BagEncoding::kCdr, topics_++};
  reader.entity = checked_dds(
      dds_create_reader(node_.participant_, node_.topic_of(topic, type_to_read(type)), qos.get(), nullptr),
      "the topic " + topic);
  dds_set_status_mask(reader.entity, DDS_DATA_AVAILABLE_STATUS);
  dds_waitset_attach(waitset_, reader.entity, 0);
  node_.announcement_->add_reader(reader.entity);
  readers_.emplace(topic, std::move(reader));
}

void DdsInbox::unsubscribe(const std::string& topic) {
  const auto found = readers_.find(topic);
  if (found == readers_.end()) return;
  close(found->second);
  readers_.erase(found);
}

std::uint64_t DdsInbox::take(std::deque<RosSample>& samples, double timeout_s) {
  dds_attach_t ready[1];
  dds_waitset_wait(waitset_, ready, 1, static_cast<dds_duration_t>(timeout_s * 1e9));
  std::vector<TimedSample> taken;
  std::uint64_t lost = 0;
  for (auto& [topic, reader] : readers_) {
    const std::uint64_t lost_before = reader.lost;
    take_from(reader, taken);
    lost += reader.lost - lost_before;
  }
  std::stable_sort(taken.begin(), taken.end(),
                   [](const TimedSample& a, const TimedSample& b) { return a.first < b.first; });
  for (TimedSample& one : taken) samples.push_back(std::move(one.second));
  return lost;
}

std::uint64_t DdsInbox::publisher_of(Reader& reader, dds_instance_handle_t handle) {
  const auto [entry, is_new] = reader.publishers.emplace(handle, 0);
  if (is_new) {
    dds_builtintopic_endpoint_t* const endpoint = dds_get_matched_publication_data(reader.entity, handle);
    if (endpoint != nullptr) {
      entry->second = id_of_guid(endpoint->key);
      dds_builtintopic_free_endpoint(endpoint);
    }
  }
  return entry->second;
}

void DdsInbox::take_from(Reader& reader, std::vector<TimedSample>& samples) {
  constexpr std::uint32_t kMost = 64;
  ddsi_serdata* data[kMost];
  dds_sample_info_t infos[kMost];
  dds_return_t count = 0;
  do {
    count = dds_takecdr(reader.entity, data, kMost, infos, DDS_ANY_STATE);
    for (dds_return_t i = 0; i < count; ++i) {
      if (infos[i].valid_data) {
        RosSample sample{reader.topic, publisher_of(reader, infos[i].publication_handle),
                         std::string(ddsi_serdata_size(data[i]), '\0')};
        ddsi_serdata_to_ser(data[i], 0, sample.bytes.size(), sample.bytes.data());
        samples.emplace_back(infos[i].source_timestamp, std::move(sample));
      }
      ddsi_serdata_unref(data[i]);
    }
  } while (count == static_cast<dds_return_t>(kMost));
  dds_sample_lost_status_t lost;
  dds_sample_rejected_status_t rejected;
  if (dds_get_sample_lost_status(reader.entity, &lost) == DDS_RETCODE_OK &&
      dds_get_sample_rejected_status(reader.entity, &rejected) == DDS_RETCODE_OK)
    reader.lost = lost.total_count + rejected.total_count;
}

}  // namespace psi_slam
