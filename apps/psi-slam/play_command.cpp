// SPDX-License-Identifier: BSD-3-Clause
#include <chrono>
#include <ostream>
#include <thread>

#include "base/exit_code.h"
#include "commands.h"
#include "interrupt_signals.h"
#include "live/ros2_link.h"
#include "psi_slam/open_log.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr double kWaitForListener_s = 10;

/// Waits until a frame is due. Frames whose stamps run backwards are due at once.
class Pace {
 public:
  explicit Pace(double speed) : speed_(speed) {}

  void wait_for(TimeUs time_us, const std::atomic<bool>& is_interrupted) {
    if (speed_ == 0) return;
    if (!first_us_ || time_us < *first_us_) {
      first_us_ = time_us;
      began_ = Clock::now();
    }
    const auto due = began_ + std::chrono::duration_cast<Clock::duration>(
                                  std::chrono::duration<double>(seconds(time_us - *first_us_) / speed_));
    while (Clock::now() < due && !is_interrupted)
      std::this_thread::sleep_until(std::min(due, Clock::now() + std::chrono::milliseconds(100)));
  }

 private:
  using Clock = std::chrono::steady_clock;
  double speed_;
  std::optional<TimeUs> first_us_;
  Clock::time_point began_;
};

}  // namespace

int play_log(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  load_settings(line, bound, streams);
  const Ros2Options options = ros2_options(line.play.ros2, "psi_slam_player");
  const auto log = open_log(line.log, log_options(bound.settings));
  const auto player = open_ros2_player(options);
  const InterruptSignals signals;
  std::optional<Frame> frame = log->next();
  if (frame && !player->wait_for_listener(*frame, kWaitForListener_s) && !line.quiet)
    streams.err << "psi-slam: no node receives the scans after 10 s; playing anyway\n";
  WorkProgress progress(streams.err_is_terminal && !line.quiet ? &streams.err : nullptr);
  Pace pace(line.play.speed);
  std::size_t scans = 0;
  int code = kExitDone;
  try {
    for (; frame && !signals.came(); frame = log->next(), ++scans) {
      pace.wait_for(frame->time_us, signals.came());
      player->publish(*frame);
      progress.show("playing", log->progress(), 1);
    }
  } catch (const UserError& error) {
    if (scans == 0) throw;
    progress.clear();
    streams.err << "psi-slam: " << error.what() << '\n';
    code = kExitWrongUsageOrInput;
  }
  progress.clear();
  if (!line.quiet) streams.out << "played " << scans << " scans\n";
  return code;
}

}  // namespace psi_slam
