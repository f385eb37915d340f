// SPDX-License-Identifier: BSD-3-Clause
// A finished map for Python. All arrays come from the functions that write the files of the program.
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "base/scope_exit.h"
#include "map/trajectory/trajectory_file.h"
#include "psi_slam/mapping_session.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// A session that several Python threads may use.
class SharedSession {
 public:
  explicit SharedSession(std::vector<std::string> settings_warnings)
      : settings_warnings_(std::move(settings_warnings)) {}

  /// Calls `work` with the session, without the interpreter's lock, while no other thread uses the session.
  /// Throws UserError if `work` of this thread calls use() again, as a progress function may.
  template <class Work>
  auto use(const Work& work) {
    if (user_ == std::this_thread::get_id())
      throw UserError(
          "Mapper: a progress function or signal handler cannot use the mapper that calls it. Use the mapper "
          "after finish()");
    const pybind11::gil_scoped_release unlocked;
    const std::lock_guard lock(mutex_);
    user_ = std::this_thread::get_id();
    const ScopeExit leave([&] { user_ = std::thread::id(); });
    return work(session_);
  }

  /// Warnings about renamed settings, one sentence each.
  const std::vector<std::string>& settings_warnings() const { return settings_warnings_; }

 private:
  std::mutex mutex_;
  std::atomic<std::thread::id> user_{};  ///< thread that uses the session; no thread's id: none
  std::unique_ptr<MappingSession> session_;
  std::vector<std::string> settings_warnings_;
};

/// The class psi_slam.Result. Computes each property when it is first read.
class PythonResult {
 public:
  /// `session` holds a finished session.
  explicit PythonResult(std::shared_ptr<SharedSession> session) : session_(std::move(session)) {}

  pybind11::object poses();
  pybind11::object covariances();
  pybind11::object loops();
  pybind11::object grid_map();
  pybind11::object verdict();
  pybind11::object summary();
  pybind11::object settings();
  pybind11::list warnings();
  bool interrupted();
  pybind11::object broken_off();
  void save(const std::filesystem::path& folder, bool force);
  std::string repr();

  /// Poses of the robot in the exported map.
  Trajectory trajectory();

 private:
  /// Returns the value of a property, and makes it when it is first read.
  template <class Make>
  pybind11::object once(const char* name, const Make& make);
  void draw();

  std::shared_ptr<SharedSession> session_;
  pybind11::dict made_;
};

/// Adds the classes Result, GridMap, Verdict and HotSpot.
void bind_result(pybind11::module_& module);

}  // namespace psi_slam
