// SPDX-License-Identifier: BSD-3-Clause
#include "ros2/network_watch.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/number_text.h"
#include "base/text_parts.h"
#include "logs/rosbag/bag_topics.h"
#include "logs/rosbag/ros_messages.h"

namespace psi_slam {
namespace {

constexpr double kSilent_s = 5;        // time without messages that is worth a sentence
constexpr double kMaximumLag_s = 2;    // seconds of odometry behind the scans
constexpr double kClockDiffers_s = 1;  // seconds
constexpr int kScansToCompareClocks = 20;
constexpr double kDay_s = 86'400;

std::string seconds_text(double time_s) {
  return trimmed_text(time_s, 1) + " s";
}

}  // namespace

NetworkWatch::NetworkWatch(NetworkFacts facts, std::string map_frame, Notify notify)
    : facts_(std::move(facts)), map_frame_(std::move(map_frame)), notify_(std::move(notify)) {}

bool is_any_scan(const BagTopic& topic) {
  return has_scans(topic, false) || has_scans(topic, true);
}

void NetworkWatch::set_plan(const BagPlan& plan) {
  plan_ = plan;
  for (const std::string& assumption : plan.assumptions) notify_(assumption);
}

bool NetworkWatch::report(const std::string& fault, bool is_present,
                          const std::function<std::string()>& sentence) {
  if (!is_present) {
    present_.erase(fault);
  } else if (present_.insert(fault).second) {
    notify_(sentence());
  }
  return is_present;
}

bool NetworkWatch::is_scan(const BagTopic& topic) const {
  if (!plan_) return is_any_scan(topic);
  const auto& topics = plan_->scan_topics;
  return std::find(topics.begin(), topics.end(), topic.name) != topics.end();
}

void NetworkWatch::take(const RosSample& sample, double now_s, std::optional<TimeUs> received_us) {
  if (!began_s_) began_s_ = now_s;
  try {
    if (is_scan(sample.topic)) {
      take_scan(sample, now_s, received_us);
    } else if (is_transforms(sample.topic)) {
      take_transforms(sample, now_s);
    } else if (plan_ && sample.topic.name == plan_->odometry_topic) {
      take_odometry(sample, read_ros_header({&sample.topic, 0, sample.bytes}).time_us, now_s);
    }
  } catch (const MalformedBytes&) {
    // The reader of the bag counts damaged messages.
  }
}

void NetworkWatch::take_scan(const RosSample& sample, double now_s, std::optional<TimeUs> received_us) {
  const TimeUs stamp_us = read_ros_header({&sample.topic, 0, sample.bytes}).time_us;
  if (scan_ && now_s - scan_->last_s >= kSilent_s)
    notify_("scans have resumed after " + seconds_text(now_s - scan_->last_s));
  present_.erase("silent");
  Source& of_topic = scans_[sample.topic.name];
  const bool is_new = of_topic.publisher != 0 && of_topic.publisher != sample.publisher;
  if (is_new && now_s - of_topic.last_s >= 1)
    notify_("the publisher of " + sample.topic.name + " was restarted: " + facts_.node_of(sample.publisher));
  of_topic = Source{now_s, stamp_us, sample.publisher};
  scan_ = Source{now_s, stamp_us, sample.publisher};
  if (received_us && stamp_us != 0) compare_clocks(stamp_us, *received_us);
}

void NetworkWatch::compare_clocks(TimeUs stamp_us, TimeUs received_us) {
  const double ahead_s = seconds(stamp_us - received_us);
  clock_differs_ = std::abs(ahead_s) > kClockDiffers_s ? clock_differs_ + 1 : 0;
  report("clock", clock_differs_ >= kScansToCompareClocks, [&] {
    if (std::abs(ahead_s) > kDay_s)
      return "the scans are stamped " + trimmed_text(std::abs(ahead_s) / kDay_s, 1) + " days " +
             (ahead_s > 0 ? "after" : "before") +
             " the time of this computer, as in a log that is played without /clock. If other programs need "
             "the time, play the log with /clock (ros2 bag play --clock)";
    return "the scans are stamped " + seconds_text(std::abs(ahead_s)) + (ahead_s > 0 ? " after" : " before") +
           " the time of this computer. Mapping needs only the robot's clock. Other programs need equal "
           "clocks: run chrony or ntpd on both computers";
  });
}

void NetworkWatch::take_transforms(const RosSample& sample, double now_s) {
  for (const RosTransform& transform : read_ros_transforms({&sample.topic, 0, sample.bytes})) {
    const bool is_pose_in_map =
        transform.header.frame == map_frame_ && plan_ &&
        (transform.child_frame == plan_->odom_frame || transform.child_frame == plan_->base_frame);
    if (is_pose_in_map)
      report("map", true, [&] {
        return facts_.node_of(sample.publisher) + " also publishes the transform from " + map_frame_ +
               " to " + transform.child_frame +
               ". Stop the other SLAM or localization program: with two, the robot's pose jumps";
      });
    if (!plan_ || !plan_->has_odometry || transform.header.frame != plan_->odom_frame ||
        transform.child_frame != plan_->base_frame)
      continue;
    const auto [entry, is_new] = odometry_heard_s_.emplace(sample.publisher, Span{now_s, now_s});
    entry->second.last_s = now_s;
    auto& heard = odometry_heard_s_;
    for (auto one = heard.begin(); one != heard.end();)
      one = now_s - one->second.last_s > kSilent_s ? heard.erase(one) : std::next(one);
    // A publisher that was restarted sends nothing after the first message of the new one.
    const bool both = std::any_of(heard.begin(), heard.end(), [&](const auto& a) {
      return std::any_of(heard.begin(), heard.end(), [&](const auto& b) {
        return a.first != b.first && a.second.first_s <= b.second.first_s &&
               a.second.last_s > b.second.first_s + kClockDiffers_s;
      });
    });
    report("two odometries", both, [&] {
      std::string nodes;
      for (const auto& [publisher, span] : heard)
        nodes += (nodes.empty() ? "" : " and ") + facts_.node_of(publisher);
      return nodes + " both publish the transform from " + plan_->odom_frame + " to " + plan_->base_frame +
             ". Stop one of them, because their poses differ";
    });
    if (plan_->odometry_topic.empty()) take_odometry(sample, transform.header.time_us, now_s);
  }
}

void NetworkWatch::take_odometry(const RosSample& sample, TimeUs stamp_us, double now_s) {
  if (odometry_ && odometry_->publisher != sample.publisher && now_s - odometry_->last_s >= 1)
    notify_("the publisher of odometry was restarted: " + facts_.node_of(sample.publisher));
  odometry_ = Source{now_s, stamp_us, sample.publisher};
}

void NetworkWatch::pass_time(double now_s) {
  if (!began_s_) began_s_ = now_s;
  const double last_scan_s = scan_ ? scan_->last_s : *began_s_;
  const bool is_silent = report("silent", now_s - last_scan_s >= kSilent_s, [&] {
    return "no scan for " + seconds_text(kSilent_s) + ": " + facts_.describe();
  });
  if (is_silent || !plan_ || !plan_->has_odometry || !scan_) return;
  if (!planned_s_) planned_s_ = now_s;
  const double last_odometry_s = odometry_ ? odometry_->last_s : *planned_s_;
  const bool has_stopped = report("no odometry", now_s - last_odometry_s >= kSilent_s, [&] {
    return "no odometry for " + seconds_text(kSilent_s) +
           ", while scans arrive. Scans wait for odometry. Check the node that publishes " +
           (plan_->odometry_topic.empty() ? plan_->odom_frame + " to " + plan_->base_frame
                                          : plan_->odometry_topic);
  });
  if (has_stopped || !odometry_) return;
  const double lag_s = seconds(scan_->stamp_us - odometry_->stamp_us);
  const bool comes = now_s - odometry_->last_s < kMaximumLag_s / 2;
  report("late odometry", comes && lag_s > kMaximumLag_s, [&] {
    return "the stamps of odometry are " + seconds_text(lag_s) +
           " behind those of the scans. Poses are late by as much. Check the clocks of the computers that "
           "publish them";
  });
}

}  // namespace psi_slam
