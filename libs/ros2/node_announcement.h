// SPDX-License-Identifier: BSD-3-Clause
// Tells the nodes of ROS 2 which readers and writers belong to this node, on the topic ros_discovery_info.
// Without it, `ros2 node list`, `ros2 topic info -v` and RViz would not show the node.
#pragma once

#include <dds/dds.h>

#include <condition_variable>
#include <cstdint>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>

namespace psi_slam {

/// Number of a reader or writer in this process, made of its GUID.
std::uint64_t id_of_guid(const dds_guid_t& guid);

/// Announces a node from a thread of its own. Iron and later use 16 bytes for each identifier, Humble and
/// earlier 24 bytes, under the same type name. The node follows other nodes, and uses 16 until one announces
/// itself.
class NodeAnnouncement {
 public:
  NodeAnnouncement(dds_entity_t participant, std::string name, std::string name_space);
  ~NodeAnnouncement();
  NodeAnnouncement(const NodeAnnouncement&) = delete;
  NodeAnnouncement& operator=(const NodeAnnouncement&) = delete;

  void add_reader(dds_entity_t reader);
  void remove_reader(dds_entity_t reader);
  void add_writer(dds_entity_t writer);

  /// Returns the name of the node that has a writer, such as "/robot1/driver"; empty if it is unknown.
  std::string node_of(std::uint64_t writer_id) const;

 private:
  void work();
  template <class Info>
  void take(dds_entity_t reader);
  template <class Info>
  void announce(dds_entity_t writer) const;

  dds_entity_t participant_;
  std::string name_;
  std::string name_space_;
  dds_entity_t readers_of_others_[2] = {0, 0};  ///< with 16 and with 24 bytes
  dds_entity_t announcers_[2] = {0, 0};         ///< writers with 16 and with 24 bytes; 0: not made yet

  mutable std::mutex mutex_;  ///< protects the members below
  std::condition_variable changed_;
  std::set<dds_entity_t> readers_;
  std::set<dds_entity_t> writers_;
  std::map<std::uint64_t, std::string> nodes_;  ///< names of nodes by their writers
  bool has_news_ = true;
  bool others_use_24_bytes_ = false;
  bool stop_ = false;

  std::thread thread_;
};

}  // namespace psi_slam
