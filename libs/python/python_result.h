// SPDX-License-Identifier: BSD-3-Clause
// A finished map for Python. All arrays come from the functions that write the files of the program.
#pragma once

#include <pybind11/pybind11.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "psi_slam/mapping_session.h"
#include "trajectory/trajectory_file.h"

namespace psi_slam {

/// A session that several Python threads may use.
class SharedSession {
 public:
  explicit SharedSession(std::vector<std::string> settings_warnings)
      : settings_warnings_(std::move(settings_warnings)) {}

  /// Calls `work` with the session, without the interpreter's lock, while no other thread uses the session.
  template <class Work>
  auto use(const Work& work) {
    const pybind11::gil_scoped_release unlocked;
    const std::lock_guard lock(mutex_);
    return work(session_);
  }

  /// Warnings about renamed settings, one sentence each.
  const std::vector<std::string>& settings_warnings() const { return settings_warnings_; }

 private:
  std::mutex mutex_;
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
