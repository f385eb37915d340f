// SPDX-License-Identifier: BSD-3-Clause
// Measures the time from a scan on /scan to the pose of psi-slam on /pose.
//
//     measure_latency LOG SPEED [BEAMS]
//
// Plays a log as a ROS 2 robot, while `psi-slam live --ros2` maps in another process. With BEAMS, each scan
// is sent with so many beams, which repeat those of the log. Prints the number of scans that were sent and
// mapped, and the quantiles of the time.
#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>
#include <thread>
#include <vector>

#include "logs/rosbag/ros_messages.h"
#include "psi_slam/open_log.h"
#include "ros2/dds_inbox.h"
#include "ros2/log_player.h"

namespace {

using psi_slam::Frame;
using psi_slam::TimeUs;
using Clock = std::chrono::steady_clock;

/// Sends each beam several times, at bearings between those of its neighbours.
void repeat_beams(Frame& frame, std::size_t beams) {
  const std::vector<float>& bearings = *frame.scan.bearings_rad;
  const std::size_t given = bearings.size();
  auto more = std::make_shared<std::vector<float>>();
  std::vector<float> ranges;
  for (std::size_t i = 0; i < beams; ++i) {
    const float share = static_cast<float>(i) / static_cast<float>(beams - 1);
    more->push_back(bearings.front() + share * (bearings.back() - bearings.front()));
    ranges.push_back(frame.scan.ranges_m[std::min(given - 1, i * given / beams)]);
  }
  frame.scan.bearings_rad = std::move(more);
  frame.scan.ranges_m = std::move(ranges);
}

double quantile_ms(const std::vector<double>& sorted_ms, double share) {
  return sorted_ms.empty()
             ? 0
             : sorted_ms[static_cast<std::size_t>(share * static_cast<double>(sorted_ms.size() - 1))];
}

int measure(const std::string& path, double speed, std::size_t beams) {
  std::vector<Frame> frames;
  const auto log = psi_slam::open_log(path, {});
  while (auto frame = log->next()) {
    if (beams > 0) repeat_beams(*frame, beams);
    frames.push_back(*std::move(frame));
  }
  psi_slam::Ros2Options robot;
  robot.name = "robot";
  psi_slam::LogPlayer player(robot);
  psi_slam::DdsNode node(psi_slam::dds_network(std::nullopt), "listener", "/");
  psi_slam::DdsInbox inbox(node);
  inbox.subscribe("/pose", "geometry_msgs/PoseWithCovarianceStamped", psi_slam::RosReading::kBestEffort);
  if (!player.wait_for_listener(frames.front(), 30)) {
    std::fprintf(stderr, "measure_latency: psi-slam live --ros2 does not run in this domain\n");
    return 2;
  }
  std::atomic<bool> has_ended = false;
  std::map<TimeUs, Clock::time_point> poses;
  std::thread listener([&] {
    while (!has_ended) {
      std::deque<psi_slam::RosSample> samples;
      inbox.take(samples, 0.2);
      for (const auto& sample : samples)
        poses.emplace(psi_slam::read_ros_header({&sample.topic, 0, sample.bytes}).time_us, Clock::now());
    }
  });
  std::map<TimeUs, Clock::time_point> sent;
  const auto began = Clock::now();
  for (const Frame& frame : frames) {
    const double due_s = psi_slam::seconds(frame.time_us - frames.front().time_us) / speed;
    std::this_thread::sleep_until(
        began + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(due_s)));
    sent.emplace(frame.time_us, Clock::now());
    player.publish(frame);
  }
  std::this_thread::sleep_for(std::chrono::seconds(2));
  has_ended = true;
  listener.join();
  // Scans of the first seconds wait until it is decided what is read.
  const TimeUs first_us = frames.front().time_us + static_cast<TimeUs>(10e6 * speed);
  std::vector<double> times_ms;
  std::size_t timed = 0;
  for (const auto& [time_us, when] : sent) {
    if (time_us < first_us) continue;
    ++timed;
    if (const auto pose = poses.find(time_us); pose != poses.end())
      times_ms.push_back(std::chrono::duration<double, std::milli>(pose->second - when).count());
  }
  std::sort(times_ms.begin(), times_ms.end());
  std::printf(
      "%zu scans sent, %zu poses; of %zu scans after 10 s, %zu poses: p50 %.2f ms, p99 %.2f ms, longest %.2f "
      "ms\n",
      sent.size(), poses.size(), timed, times_ms.size(), quantile_ms(times_ms, 0.5),
      quantile_ms(times_ms, 0.99), quantile_ms(times_ms, 1));
  return 0;
}

}  // namespace

int main(int count, char** words) {
  if (count < 3) {
    std::fprintf(stderr, "usage: measure_latency LOG SPEED [BEAMS]\n");
    return 2;
  }
  return measure(words[1], std::atof(words[2]),
                 count > 3 ? static_cast<std::size_t>(std::atol(words[3])) : 0);
}
