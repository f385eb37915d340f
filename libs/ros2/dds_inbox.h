// SPDX-License-Identifier: BSD-3-Clause
// Receives messages of several topics, as bytes.
#pragma once

#include <dds/dds.h>

#include <cstdint>
#include <deque>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "logs/rosbag/bag_file.h"
#include "ros2/dds_node.h"

namespace psi_slam {

/// One message as it came from the network.
struct RosSample {
  BagTopic topic;
  std::uint64_t publisher = 0;  ///< RosPublisher::id
  std::string bytes;            ///< CDR, with the four bytes that state the encoding
};

/// How a topic is read.
enum class RosReading {
  kBestEffort,  ///< from every writer; without waiting for lost messages
  kReliable,    ///< every message of reliable writers
  kLatched,     ///< as kReliable, also the last messages that latched writers sent before, as on /tf_static
};

/// Readers of a node. Used by one thread.
class DdsInbox {
 public:
  explicit DdsInbox(DdsNode& node);
  ~DdsInbox();
  DdsInbox(const DdsInbox&) = delete;
  DdsInbox& operator=(const DdsInbox&) = delete;

  /// Receives the messages of a topic from now on. Does nothing if the topic is received already. Throws
  /// std::invalid_argument if psi-slam does not know the type.
  void subscribe(const std::string& topic, const std::string& type, RosReading reading);
  void unsubscribe(const std::string& topic);

  /// Waits until messages have come, or until `timeout_s` has passed, and appends them in the order in which
  /// they were sent. Returns the number of messages that were lost since the last call: on the network, or
  /// because the queue of 20,000 messages was full.
  std::uint64_t take(std::deque<RosSample>& samples, double timeout_s);

 private:
  struct Reader {
    BagTopic topic;
    dds_entity_t entity = 0;
    std::uint64_t lost = 0;
    std::map<dds_instance_handle_t, std::uint64_t> publishers;  ///< RosPublisher::id by the handles of DDS
  };
  using TimedSample = std::pair<dds_time_t, RosSample>;

  static std::uint64_t publisher_of(Reader& reader, dds_instance_handle_t handle);
  static void take_from(Reader& reader, std::vector<TimedSample>& samples);
  void close(const Reader& reader);

  DdsNode& node_;
  dds_entity_t waitset_ = 0;
  std::map<std::string, Reader> readers_;  ///< by their topics
  std::int64_t topics_ = 0;                ///< number of topics that were subscribed so far
};

}  // namespace psi_slam
