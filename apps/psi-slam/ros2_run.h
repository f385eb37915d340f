// SPDX-License-Identifier: BSD-3-Clause
// A live run as a node of ROS 2: publishes map, path, loops and state, and takes commands.
#pragma once

#include <atomic>
#include <chrono>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

#include "live/live_control.h"
#include "live/ros2_link.h"
#include "live_mapping.h"
#include "map/exports/run_summary.h"
#include "psi_slam/mapping_session.h"

namespace psi_slam {

/// Request of a user by a command on ~/command; kGoOn: none.
enum class Ros2Wish { kGoOn, kFinish, kReset, kLocalize };

/// Takes the commands that any run obeys: pause, resume, finish. Used by one thread.
class Ros2Commands {
 public:
  explicit Ros2Commands(std::shared_ptr<Ros2Link> link) : link_(std::move(link)) {}

  /// Takes the commands that have come. `take_other(name, argument)` obeys the commands of one kind of run
  /// and returns its answer; empty if it does not know the command.
  template <class TakeOther>
  void take(TakeOther take_other) {
    while (const std::optional<std::string> command = link_->next_command()) {
      const std::size_t space = command->find(' ');
      const std::string name = command->substr(0, space);
      const std::string argument = space == std::string::npos ? "" : command->substr(space + 1);
      std::optional<std::string> answer = take_common(name);
      if (!answer) answer = take_other(name, argument);
      link_->answer(answer ? name + ": " + *answer : unknown_text(*command));
    }
  }

  Ros2Wish wish() const { return wish_; }
  void set_wish(Ros2Wish wish) { wish_ = wish; }

  /// Returns `control`, and ends the source also if a command ends the run.
  LiveControl control(LiveControl control) const;

 private:
  std::optional<std::string> take_common(const std::string& name);
  static std::string unknown_text(const std::string& command);

  std::shared_ptr<Ros2Link> link_;
  std::atomic<Ros2Wish> wish_ = Ros2Wish::kGoOn;
};

/// Publishes a mapping session and obeys its commands. Used by the thread that maps.
class Ros2Run {
 public:
  Ros2Run(std::shared_ptr<Ros2Link> link, Ros2Commands& commands, MappingSession& session,
          LiveMapping& mapping, std::filesystem::path folder);

  /// Waits until a scan can be mapped or the source has ended, and obeys commands meanwhile.
  void wait_for_scan();

  /// Publishes the finished map and its verdict. `folder` holds the results.
  static void publish_result(Ros2Link& link, MappingSession& session, const RunSummary& summary,
                             const std::filesystem::path& folder);

 private:
  using Clock = std::chrono::steady_clock;

  std::optional<std::string> obey(const std::string& name, const std::string& argument);
  void publish_status() const;
  void publish_graph() const;

  std::shared_ptr<Ros2Link> link_;
  Ros2Commands& commands_;
  MappingSession& session_;
  LiveMapping& mapping_;
  std::filesystem::path folder_;
  Clock::time_point status_due_;
  Clock::time_point graph_due_;
};

}  // namespace psi_slam
