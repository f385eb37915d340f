// SPDX-License-Identifier: BSD-3-Clause
#include "logs/rosbag/begun_bag.h"

#include <algorithm>
#include <set>
#include <utility>

#include "base/text_parts.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_choice.h"
#include "logs/frames/look_over.h"
#include "logs/rosbag/bag_plan.h"
#include "logs/rosbag/ros_messages.h"

namespace psi_slam {
namespace {

constexpr std::size_t kMostOtherMessages = 10'000;

/// Distinguishes the scans that options may select from other messages.
class MessageKinds {
 public:
  explicit MessageKinds(const LogOptions& options) : slices_clouds_(height_slice(options).has_value()) {}

  bool is_scan(const BagTopic& topic) const { return has_scans(topic, slices_clouds_); }
  bool is_needed(const BagTopic& topic) const {
    return is_scan(topic) || is_transforms(topic) || topic.type == kRosOdometry || topic.type == kRosImu;
  }
  /// Returns whether a message must be kept because no later one repeats it.
  bool is_unique(const BagTopic& topic) const { return is_scan(topic) || has_word(topic.name, "static"); }

 private:
  bool slices_clouds_;
};

/// Names of the topics that the user selects.
std::set<std::string> selected_topics(const LogOptions& options) {
  const bool by_topic = !options.scan_topic.empty();
  const LaserChoice choice =
      laser_choice(by_topic ? "log.scan_topic" : "log.laser", by_topic ? options.scan_topic : options.laser);
  return {choice.names.begin(), choice.names.end()};
}

class BegunBag : public BagFile {
 public:
  BegunBag(std::shared_ptr<const BeginningOfBag> beginning, std::unique_ptr<BagFile> rest)
      : beginning_(std::move(beginning)), rest_(std::move(rest)) {}

  std::vector<BagTopic> topics() override { return beginning_->topics; }

  void want(const std::vector<std::string>& topics) override {
    BagFile::want(topics);
    if (rest_) rest_->want(topics);
  }

  bool next(BagMessage& message) override {
    if (beginning_ && next_damage_ < beginning_->damage.size()) throw beginning_->damage[next_damage_++];
    while (beginning_) {
      if (next_ == beginning_->messages.size()) {
        beginning_.reset();
        break;
      }
      const BeginningOfBag::Message& kept = beginning_->messages[next_++];
      if (!is_wanted(kept.topic)) continue;
      message_ = kept;
      message = {&message_.topic, message_.recorded_us, message_.bytes};
      return true;
    }
    while (rest_ && rest_->next(message))
      if (is_wanted(*message.topic)) return true;
    return false;
  }

  double progress() const override { return 0; }
  std::string place() const override { return beginning_ || !rest_ ? message_.place : rest_->place(); }

 private:
  std::shared_ptr<const BeginningOfBag> beginning_;  // null after its last message
  std::size_t next_ = 0;
  std::size_t next_damage_ = 0;
  BeginningOfBag::Message message_;
  std::unique_ptr<BagFile> rest_;
};

/// Reads the next message, and adds the damaged parts before it to a list. Returns false at the end.
bool next_message(BagFile& recording, BagMessage& message, std::vector<DamagedPart>& damage) {
  while (true) {
    try {
      return recording.next(message);
    } catch (const DamagedPart& part) {
      damage.push_back(part);
    }
  }
}

}  // namespace

BeginningOfBag read_beginning(BagFile& recording, const LogOptions& options, double look_over_s) {
  const MessageKinds kinds(options);
  std::set<std::string> awaited = selected_topics(options);
  LookOver scans(look_over_s);
  BeginningOfBag beginning;
  std::deque<BeginningOfBag::Message>& kept = beginning.messages;
  std::size_t others = 0;
  for (BagMessage message;
       !scans.is_enough(!awaited.empty()) && next_message(recording, message, beginning.damage);) {
    const BagTopic& topic = *message.topic;
    add_topic(beginning.topics, topic);
    if (!kinds.is_needed(topic)) continue;
    kept.push_back({topic, message.recorded_us, std::string(message.bytes), recording.place()});
    if (kinds.is_scan(topic)) {
      scans.add_scan(message.recorded_us);
      for (const std::string& name : names_of_topic(topic.name)) awaited.erase(name);
    } else if (!kinds.is_unique(topic) && ++others > kMostOtherMessages) {
      kept.erase(std::find_if(kept.begin(), kept.end(),
                              [&](const auto& one) { return !kinds.is_unique(one.topic); }));
      --others;
    }
  }
  std::stable_sort(beginning.topics.begin(), beginning.topics.end(),
                   [](const BagTopic& a, const BagTopic& b) { return a.number < b.number; });
  return beginning;
}

std::unique_ptr<BagFile> begun_bag(std::shared_ptr<const BeginningOfBag> beginning,
                                   std::unique_ptr<BagFile> rest) {
  return std::make_unique<BegunBag>(std::move(beginning), std::move(rest));
}

}  // namespace psi_slam
