// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/node_announcement.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

#include "ros2/dds_entities.h"
#include "ros2/message_views.h"
#include "ros2_messages.h"

namespace psi_slam {
namespace {

using Info16 = rmw_dds_common_msg_dds__ParticipantEntitiesInfo_;
using Info24 = rmw_dds_common_msg_dds__ParticipantEntitiesInfo24_;

constexpr std::size_t kBytesOfGuid = 16;
constexpr const char* kTopic = "ros_discovery_info";
constexpr auto kPeriod = std::chrono::milliseconds(200);
constexpr int kPeriodsToListen = 5;  // before the first announcement, so that others can show their layout

/// Both layouts have this type name.
dds_topic_descriptor_t type_with_24_bytes() {
  dds_topic_descriptor_t type = rmw_dds_common_msg_dds__ParticipantEntitiesInfo24__desc;
  type.m_typename = rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc.m_typename;
  return type;
}

DdsQos quality() {
  DdsQos qos = make_dds_qos();
  dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, DDS_SECS(1));
  latch(qos.get(), 1);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
  dds_qset_writer_data_lifecycle(qos.get(), false);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  return qos;
}

dds_entity_t topic(dds_entity_t participant, bool has_24_bytes) {
  static const dds_topic_descriptor_t old_type = type_with_24_bytes();
  return dds_create_topic(participant,
                          has_24_bytes ? &old_type : &rmw_dds_common_msg_dds__ParticipantEntitiesInfo__desc,
                          kTopic, nullptr, nullptr);
}

template <class Gid>
Gid gid_of(dds_entity_t entity) {
  Gid gid{};
  dds_guid_t guid{};
  if (dds_get_guid(entity, &guid) == DDS_RETCODE_OK) std::memcpy(gid.data, guid.v, kBytesOfGuid);
  return gid;
}

template <class Gid>
std::vector<Gid> gids_of(const std::set<dds_entity_t>& entities) {
  std::vector<Gid> gids;
  for (const dds_entity_t entity : entities) gids.push_back(gid_of<Gid>(entity));
  return gids;
}

/// Whether an announcement was read with the layout in which it was written. A message with 16 bytes that is
/// read with 24 has numbers after them, not zeros.
bool has_this_layout(const Info16&) {
  return true;
}
bool has_this_layout(const Info24& info) {
  return std::all_of(info.gid.data + kBytesOfGuid, info.gid.data + sizeof info.gid.data,
                     [](std::uint8_t byte) { return byte == 0; });
}

}  // namespace

std::uint64_t id_of_guid(const dds_guid_t& guid) {
  std::uint64_t halves[2];
  std::memcpy(halves, guid.v, sizeof halves);
  return halves[0] ^ (halves[1] * 0x9E3779B97F4A7C15U);
}

NodeAnnouncement::NodeAnnouncement(dds_entity_t participant, std::string name, std::string name_space)
    : participant_(participant), name_(std::move(name)), name_space_(std::move(name_space)) {
  const auto qos = quality();
  for (const bool has_24_bytes : {false, true})
    readers_of_others_[has_24_bytes ? 1 : 0] = checked_dds(
        dds_create_reader(participant_, topic(participant_, has_24_bytes), qos.get(), nullptr), kTopic);
  thread_ = std::thread([this] { work(); });
}

NodeAnnouncement::~NodeAnnouncement() {
  {
    const std::lock_guard lock(mutex_);
    stop_ = true;
  }
  changed_.notify_all();
  thread_.join();
}

void NodeAnnouncement::add_reader(dds_entity_t reader) {
  const std::lock_guard lock(mutex_);
  has_news_ = readers_.insert(reader).second || has_news_;
}

void NodeAnnouncement::remove_reader(dds_entity_t reader) {
  const std::lock_guard lock(mutex_);
  has_news_ = readers_.erase(reader) > 0 || has_news_;
}

void NodeAnnouncement::add_writer(dds_entity_t writer) {
  const std::lock_guard lock(mutex_);
  has_news_ = writers_.insert(writer).second || has_news_;
}

std::string NodeAnnouncement::node_of(std::uint64_t writer_id) const {
  const std::lock_guard lock(mutex_);
  const auto found = nodes_.find(writer_id);
  return found == nodes_.end() ? std::string() : found->second;
}

void NodeAnnouncement::work() {
  std::unique_lock lock(mutex_);
  for (int period = 0; !stop_; ++period) {
    take<Info16>(readers_of_others_[0]);
    take<Info24>(readers_of_others_[1]);
    if (has_news_ && period >= kPeriodsToListen) {
      has_news_ = false;
      dds_entity_t& writer = announcers_[others_use_24_bytes_ ? 1 : 0];
      if (writer == 0)
        writer = dds_create_writer(participant_, topic(participant_, others_use_24_bytes_), quality().get(),
                                   nullptr);
      others_use_24_bytes_ ? announce<Info24>(writer) : announce<Info16>(writer);
    }
    changed_.wait_for(lock, kPeriod, [this] { return stop_; });
  }
}

/// Takes the announcements of other nodes.
template <class Info>
void NodeAnnouncement::take(dds_entity_t reader) {
  void* sample = nullptr;
  dds_sample_info_t state;
  while (dds_take(reader, &sample, &state, 1, 1) == 1) {
    const Info* const info = static_cast<const Info*>(sample);
    if (state.valid_data && has_this_layout(*info)) {
      if (sizeof info->gid.data > kBytesOfGuid && !others_use_24_bytes_)
        others_use_24_bytes_ = has_news_ = true;
      for (std::uint32_t i = 0; i < info->node_entities_info_seq._length; ++i) {
        const auto& node = info->node_entities_info_seq._buffer[i];
        const std::string space = node.node_namespace;
        const std::string name = space + (space == "/" ? "" : "/") + node.node_name;
        for (std::uint32_t j = 0; j < node.writer_gid_seq._length; ++j) {
          dds_guid_t guid{};
          std::memcpy(guid.v, node.writer_gid_seq._buffer[j].data, kBytesOfGuid);
          nodes_[id_of_guid(guid)] = name;
        }
      }
    }
    dds_return_loan(reader, &sample, 1);
    sample = nullptr;
  }
}

template <class Info>
void NodeAnnouncement::announce(dds_entity_t writer) const {
  Info info{};
  using Gid = decltype(info.gid);
  using Node = std::remove_reference_t<decltype(*info.node_entities_info_seq._buffer)>;
  std::vector<Gid> readers = gids_of<Gid>(readers_);
  std::vector<Gid> writers = gids_of<Gid>(writers_);
  std::vector<Node> nodes(1);
  nodes[0].node_namespace = dds_text(name_space_);
  nodes[0].node_name = dds_text(name_);
  show(nodes[0].reader_gid_seq, readers);
  show(nodes[0].writer_gid_seq, writers);
  info.gid = gid_of<Gid>(participant_);
  show(info.node_entities_info_seq, nodes);
  dds_write(writer, &info);
}

}  // namespace psi_slam
