// SPDX-License-Identifier: BSD-3-Clause
// A node of ROS 2 without ROS: a participant of DDS, the standard that ROS 2 uses on the network
// (https://www.omg.org/spec/DDS), with the names, types and settings that ROS 2 expects. It uses Cyclone DDS.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "ros2/dds_network.h"
#include "ros2/node_announcement.h"
#include "ros2_messages.h"

namespace psi_slam {

/// A publisher of another node, as DDS has discovered it.
struct RosPublisher {
  std::string topic;  ///< such as "/scan"
  std::string type;   ///< in the form of BagTopic: "sensor_msgs/LaserScan"
  std::uint64_t id = 0;
};

/// How a topic is written.
struct RosQuality {
  std::int32_t depth = 1;       ///< number of messages that are kept for slow readers
  bool is_latched = false;      ///< readers that come later get the last messages ("transient local")
  double max_blocking_s = 0.1;  ///< write() waits at most so long for slow readers
};

class DdsNode;

/// Writes messages of one type, reliably, because readers of either kind receive from such a writer.
/// `Message` is a struct that idlc made from ros2_messages.idl.
template <class Message>
class RosWriter {
 public:
  /// Returns false if the message was dropped, because slow readers still need the messages before it.
  bool write(const Message& message) const { return dds_write(writer_, &message) == DDS_RETCODE_OK; }
  /// Waits until all readers have the messages, at most so long.
  void wait_for_readers(double time_s) const {
    dds_wait_for_acks(writer_, static_cast<dds_duration_t>(time_s * 1e9));
  }
  /// Number of readers in other nodes.
  int readers() const;

 private:
  friend class DdsNode;
  explicit RosWriter(dds_entity_t writer) : writer_(writer) {}
  dds_entity_t writer_;
};

/// A node of ROS 2. Its functions may be called by several threads.
class DdsNode {
 public:
  /// `name` such as "psi_slam"; `name_space` is "/" or such as "/robot1". Throws UserError if the network
  /// cannot be used.
  DdsNode(const DdsNetwork& network, std::string name, std::string name_space);
  ~DdsNode();
  DdsNode(const DdsNode&) = delete;
  DdsNode& operator=(const DdsNode&) = delete;

  std::uint32_t domain() const { return network_.domain; }

  /// Returns the publishers of all other nodes that write topics of ROS.
  std::vector<RosPublisher> publishers() const;
  /// Number of other participants in the domain.
  int participants() const;

  /// Makes a writer of a topic, once for each topic.
  template <class Message>
  RosWriter<Message> advertise(const std::string& topic, const RosQuality& quality);

  /// Returns the domains from 0 to `last` besides its own in which there are nodes. Takes about a second.
  std::vector<std::uint32_t> other_domains_in_use(std::uint32_t last) const;

  /// Returns the name of the node that has a publisher; "an unnamed node" if it is unknown.
  std::string node_of(std::uint64_t publisher) const;

 private:
  friend class DdsInbox;

  dds_entity_t writer_of(const std::string& topic, const dds_topic_descriptor_t& type,
                         const RosQuality& quality);
  dds_entity_t topic_of(const std::string& topic, const dds_topic_descriptor_t& type) const;

  DdsNetwork network_;
  dds_entity_t participant_ = 0;
  dds_entity_t publications_ = 0;  ///< reader of the publishers that DDS discovers
  dds_entity_t participants_ = 0;  ///< reader of the participants that DDS discovers
  std::unique_ptr<NodeAnnouncement> announcement_;
};

/// The type that idlc made for a message; it is defined for each type that is written.
template <class Message>
const dds_topic_descriptor_t& type_of();

template <class Message>
RosWriter<Message> DdsNode::advertise(const std::string& topic, const RosQuality& quality) {
  return RosWriter<Message>(writer_of(topic, type_of<Message>(), quality));
}

template <class Message>
int RosWriter<Message>::readers() const {
  dds_publication_matched_status_t status;
  return dds_get_publication_matched_status(writer_, &status) == DDS_RETCODE_OK
             ? static_cast<int>(status.current_count)
             : 0;
}

}  // namespace psi_slam
