// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/network_bag.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/byte_cursor.h"
#include "base/text_parts.h"
#include "logs/frames/laser_choice.h"
#include "logs/rosbag/bag_topics.h"
#include "logs/rosbag/ros_messages.h"
#include "ros2/ros_names.h"

namespace psi_slam {
namespace {

constexpr double kWait_s = 0.1;        // between questions whether the user stops
constexpr double kDiscovery_s = 0.25;  // between searches for new topics
constexpr std::uint32_t kLastDomainToSearch = 20;
const std::string kClockTopic = "/clock";

double steady_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

TimeUs system_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

bool is_static(const std::string& topic) {
  return has_word(topic, "static");
}

}  // namespace

TimeUs RosClock::now_us() const {
  const TimeUs simulated = simulated_us;
  return simulated != 0 ? simulated : system_us();
}

NetworkBag::NetworkBag(std::shared_ptr<const void> owner, DdsNode& node, const Ros2Options& names,
                       const Ros2Reading& reading, const LiveControl& control, RosClock& clock,
                       const std::atomic<bool>& is_paused)
    : owner_(std::move(owner)),
      node_(node),
      inbox_(node),
      names_(names),
      reading_(reading),
      control_(control),
      clock_(clock),
      is_paused_(is_paused),
      watch_({[this] { return describe_network(); }, [this](std::uint64_t id) { return node_.node_of(id); }},
             "map", control.notify),
      last_message_s_(steady_s()) {
  if (!reading_.record.empty()) recorder_ = std::make_unique<McapWriter>(reading_.record, true);
}

std::vector<BagTopic> NetworkBag::topics() {
  throw std::logic_error("NetworkBag::topics");
}

std::string NetworkBag::place() const {
  return "ROS 2: message " + std::to_string(messages_) + " on " + current_.topic.name;
}

void NetworkBag::want(const std::vector<std::string>& topics) {
  BagFile::want(topics);
  for (const RosPublisher& publisher : node_.publishers())
    if (!is_needed(publisher)) inbox_.unsubscribe(publisher.topic);
}

/// Whether a publisher's messages are read: those of this robot that may be needed.
bool NetworkBag::is_of_robot(const RosPublisher& publisher) const {
  const std::string& type = publisher.type;
  if (type == "rosgraph_msgs/Clock") return publisher.topic == kClockTopic;
  const bool is_scan =
      type == kRosLaserScan || type == kRosMultiEchoScan || (type == kRosPointCloud && reading_.reads_clouds);
  const char* const name = is_scan                      ? "scan"
                           : type == kRosOdometry       ? "odom"
                           : type == kRosImu            ? "imu"
                           : type != kRosTransforms     ? nullptr
                           : is_static(publisher.topic) ? "tf_static"
                                                        : "tf";
  if (name == nullptr) return false;
  if (const auto stated = names_.topics.find(name); stated != names_.topics.end()) {
    const std::vector<std::string> topics = laser_choice("--topic " + stated->first, stated->second).names;
    return std::find(topics.begin(), topics.end(), publisher.topic) != topics.end();
  }
  return type == kRosTransforms || is_in_namespace(publisher.topic, names_.name_space);
}

/// Whether messages are read or recorded, or state the time.
bool NetworkBag::is_needed(const RosPublisher& publisher) const {
  return recorder_ || publisher.topic == kClockTopic ||
         is_wanted({publisher.topic, publisher.type, BagEncoding::kCdr, 0});
}

void NetworkBag::subscribe_to_new_topics() {
  last_discovery_s_ = steady_s();
  for (const RosPublisher& publisher : node_.publishers())
    if (is_of_robot(publisher) && is_needed(publisher))
      inbox_.subscribe(publisher.topic, publisher.type,
                       is_static(publisher.topic) ? RosReading::kLatched : RosReading::kBestEffort);
}

bool NetworkBag::take_clock(const RosSample& sample) {
  if (sample.topic.name != kClockTopic) return false;
  try {
    clock_.simulated_us = read_ros_clock({&sample.topic, 0, sample.bytes});
  } catch (const MalformedBytes&) {
    return true;
  }
  return true;
}

/// Waits for messages. Returns false at the end.
bool NetworkBag::receive() {
  while (waiting_.empty()) {
    if (control_.should_stop()) return false;
    if (steady_s() - last_discovery_s_ >= kDiscovery_s) subscribe_to_new_topics();
    const std::uint64_t lost = inbox_.take(waiting_, kWait_s);
    if (lost > 0 && lost_ == 0)
      control_.notify(
          "messages were lost, on the network or because mapping is too slow. Prefer a cable to Wi-Fi");
    lost_ += lost;
    const double now_s = steady_s();
    watch_.pass_time(now_s);
    if (!waiting_.empty()) last_message_s_ = now_s;
    if (waiting_.empty() && reading_.idle_s && now_s - last_message_s_ >= *reading_.idle_s) return false;
  }
  return true;
}

void NetworkBag::record(const BagMessage& message) {
  if (!recorder_) return;
  recorder_->add(message);
  if (const auto news = recorder_notice_.news(recorder_->failure())) control_.notify(*news);
}

bool NetworkBag::next(BagMessage& message) {
  while (receive()) {
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    const bool is_clock = take_clock(current_);
    message = {&current_.topic, clock_.now_us(), current_.bytes};
    const bool is_scan = has_scans(current_.topic, reading_.reads_clouds);
    if (!is_clock)
      watch_.take(current_, steady_s(), clock_.is_simulated() ? std::nullopt : std::optional(system_us()));
    if (is_paused_ && is_scan) continue;
    record(message);
    if (is_clock || !is_wanted(current_.topic)) continue;
    ++messages_;
    return true;
  }
  if (recorder_) recorder_->close();
  return false;
}

/// What the user can do if no scan comes.
std::string NetworkBag::describe_network() const {
  const std::string domain = "domain " + std::to_string(node_.domain());
  std::set<std::string> scans;
  std::set<std::string> others;
  for (const RosPublisher& publisher : node_.publishers())
    (is_any_scan({publisher.topic, publisher.type, BagEncoding::kCdr, 0}) ? scans : others)
        .insert(publisher.topic + (publisher.type.empty() ? "" : " (" + publisher.type + ")"));
  if (!scans.empty()) {
    const std::vector<std::string> names(scans.begin(), scans.end());
    return name_list(names) + " is published but sends nothing that arrives. Check the laser, and the " +
           "--namespace, --topic and log.slice_z_m of psi-slam";
  }
  if (!others.empty()) {
    const std::vector<std::string> names(others.begin(), others.end());
    return "no node in " + domain + " publishes scans. Start the laser's driver. Published are " +
           name_list(names);
  }
  if (node_.participants() > 0)
    return "the nodes in " + domain + " publish no topics. Start the laser's driver";
  std::string text = "no other node is in " + domain;
  for (const std::uint32_t used : node_.other_domains_in_use(kLastDomainToSearch))
    text +=
        "; there are nodes in domain " + std::to_string(used) + ": set ROS_DOMAIN_ID=" + std::to_string(used);
  return text +
         ". Check that the robot is on the same network, and that ROS_LOCALHOST_ONLY and "
         "ROS_AUTOMATIC_DISCOVERY_RANGE are equal on both computers";
}

}  // namespace psi_slam
