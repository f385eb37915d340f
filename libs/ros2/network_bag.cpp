// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/network_bag.h"

#include <algorithm>
#include <chrono>
#include <set>
#include <stdexcept>
#include <utility>

#include "base/byte_cursor.h"
#include "base/text_parts.h"
#include "logs/frames/laser_choice.h"
#include "logs/rosbag/bag_topics.h"
#include "logs/rosbag/ros_messages.h"
#include "psi_slam/user_error.h"
#include "ros2/ros_names.h"

namespace psi_slam {
namespace {

constexpr double kWait_s = 0.1;        // period of asking whether to stop
constexpr double kPrompt_s = 1;        // longest time between two readings that are prompt
constexpr double kDiscovery_s = 0.25;  // period of searching for topics
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

BagTopic topic_of(const RosPublisher& publisher) {
  return {publisher.topic, publisher.type, BagEncoding::kCdr, 0};
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
  if (!reading_.record.empty())
    recorder_ = std::make_unique<McapWriter>(reading_.record, reading_.replaces_record);
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

/// Returns whether psi-slam can use this topic of the robot.
bool NetworkBag::is_of_robot(const RosPublisher& publisher) const {
  const std::string& type = publisher.type;
  if (type == "rosgraph_msgs/Clock") return publisher.topic == kClockTopic;
  const bool is_scan =
      has_scans(topic_of(publisher), false) || (type == kRosPointCloud && reading_.reads_clouds);
  const char* const name = is_scan                      ? "scan"
                           : type == kRosOdometry       ? "odom"
                           : type == kRosImu            ? "imu"
                           : type != kRosTransforms     ? nullptr
                           : is_static(publisher.topic) ? "tf_static"
                                                        : "tf";
  if (name == nullptr) return false;
  if (const auto stated = names_.topics.find(name); stated != names_.topics.end()) {
    const std::vector<std::string> topics = laser_choice("--topic " + stated->first, stated->second).names;
    return std::any_of(topics.begin(), topics.end(), [&](const std::string& topic) {
      return in_namespace(topic, names_.name_space) == publisher.topic;
    });
  }
  const bool is_common = publisher.topic == "/tf" || publisher.topic == "/tf_static";
  return is_common || is_in_namespace(publisher.topic, names_.name_space);
}

/// Returns whether the topic is read or recorded, or states the time.
bool NetworkBag::is_needed(const RosPublisher& publisher) const {
  return recorder_ || publisher.topic == kClockTopic || is_wanted(topic_of(publisher));
}

void NetworkBag::subscribe_to_new_topics() {
  last_discovery_s_ = steady_s();
  for (const RosPublisher& publisher : node_.publishers())
    if (is_of_robot(publisher) && is_needed(publisher)) subscribe(publisher);
}

/// Another node may use a topic with a type that DDS cannot read, for example one that psi-slam publishes.
void NetworkBag::subscribe(const RosPublisher& publisher) {
  if (refused_.count(publisher.topic) > 0) return;
  try {
    inbox_.subscribe(publisher.topic, publisher.type,
                     is_static(publisher.topic) ? RosReading::kLatched : RosReading::kBestEffort);
  } catch (const UserError& error) {
    refused_.insert(publisher.topic);
    control_.notify(std::string(error.what()) + ". This topic is not read");
  }
}

/// Takes the time of a message on /clock.
void NetworkBag::take_clock(const RosSample& sample) {
  try {
    clock_.simulated_us = read_ros_clock({&sample.topic, 0, sample.bytes});
  } catch (const MalformedBytes&) {
    // The next message states the time.
  }
}

/// Waits for messages. Returns false at the end.
bool NetworkBag::receive() {
  while (waiting_.empty()) {
    if (control_.should_stop()) return false;
    if (steady_s() - last_discovery_s_ >= kDiscovery_s) subscribe_to_new_topics();
    if (inbox_.take(waiting_, kWait_s) > 0 && !std::exchange(has_lost_, true))
      control_.notify(
          "messages were lost on the network, or because mapping is too slow. Use a cable, or set "
          "log.every_nth_scan=2");
    const double now_s = steady_s();
    // After a pause of the reading, messages that came meanwhile are taken first.
    is_prompt_ = now_s - last_take_s_ < kPrompt_s;
    last_take_s_ = now_s;
    if (is_prompt_) watch_.pass_time(now_s);
    if (!waiting_.empty()) last_message_s_ = now_s;
    if (waiting_.empty() && reading_.idle_s && now_s - last_message_s_ >= *reading_.idle_s) return false;
  }
  return true;
}

void NetworkBag::record(const BagMessage& message) {
  if (!recorder_) return;
  try {
    recorder_->add(message);
  } catch (const SystemFailure& failure) {
    control_.notify(std::string("the recording ends: ") + failure.what());
    recorder_.reset();
    return;
  }
  if (const auto news = recorder_notice_.news(recorder_->failure())) control_.notify(*news);
}

void NetworkBag::end_recording() {
  if (!recorder_) return;
  recorder_->close();
  if (const auto failure = recorder_->failure()) control_.notify("the recording is incomplete: " + *failure);
  if (const std::uint64_t lost = recorder_->lost_messages(); lost > 0)
    control_.notify("the recording lacks " + std::to_string(lost) +
                    " messages, because it could not be written. Free disk space before the next run");
}

bool NetworkBag::next(BagMessage& message) {
  while (receive()) {
    current_ = std::move(waiting_.front());
    waiting_.pop_front();
    const bool is_clock = current_.topic.name == kClockTopic;
    if (is_clock) take_clock(current_);
    message = {&current_.topic, clock_.now_us(), current_.bytes};
    const bool is_scan = has_scans(current_.topic, reading_.reads_clouds);
    if (!is_clock)
      watch_.take(current_, steady_s(),
                  is_prompt_ && !clock_.is_simulated() ? std::optional(system_us()) : std::nullopt);
    if (is_paused_ && is_scan) continue;
    record(message);
    if (is_clock || !is_wanted(current_.topic)) continue;
    ++messages_;
    return true;
  }
  end_recording();
  return false;
}

/// What the user can do if no scan comes.
std::string NetworkBag::describe_network() const {
  const std::string domain = "domain " + std::to_string(node_.domain());
  std::set<std::string> scans;
  std::set<std::string> others;
  for (const RosPublisher& publisher : node_.publishers())
    (is_any_scan(topic_of(publisher)) ? scans : others)
        .insert(publisher.topic + (publisher.type.empty() ? "" : " (" + publisher.type + ")"));
  if (!scans.empty()) {
    const std::vector<std::string> names(scans.begin(), scans.end());
    return "no message arrives from " + name_list(names) +
           ". Check the laser, and psi-slam's options --namespace, --topic and log.slice_z_m";
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
        "; set ROS_DOMAIN_ID=" + std::to_string(used) + " for the nodes in domain " + std::to_string(used);
  return text +
         ". Check that the robot is on the same network. Check that ROS_LOCALHOST_ONLY and "
         "ROS_AUTOMATIC_DISCOVERY_RANGE are equal on both computers";
}

}  // namespace psi_slam
