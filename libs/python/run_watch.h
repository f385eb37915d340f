// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <pybind11/pybind11.h>

#include <atomic>
#include <chrono>
#include <exception>
#include <optional>

#include "psi_slam/mapping_session.h"

namespace psi_slam {

/// Progress of a run for Python. While log.calibrate estimates, `phase` is "calibrating".
struct PythonProgress {
  const char* phase = "mapping";  ///< "calibrating", "mapping", "prior map" or "final search"
  double share = 0;               ///< completed share of the phase, in [0, 1]
  std::size_t scans = 0;
  double scans_per_s = 0;
  double elapsed_s = 0;
  std::optional<double> remaining_s;
};

/// Watches a run that works without the interpreter's lock. Takes the lock at most every 50 ms, and at the
/// start of a phase, to handle signals and to report the progress to a Python function.
///
/// The first Ctrl-C makes stop() true; the run then finishes the map of the scans so far. The second one
/// throws pybind11::error_already_set out of the run. If the Python function, or a signal handler, raises
/// another exception, stop() becomes true, the function is not called again, and result_or_raise() raises the
/// exception.
class RunWatch {
 public:
  /// Needs the interpreter's lock. `progress` is None or a function that takes a Progress.
  explicit RunWatch(pybind11::object progress);
  RunWatch(const RunWatch&) = delete;
  RunWatch& operator=(const RunWatch&) = delete;

  // These three functions are called without the interpreter's lock.
  void show(const SessionProgress& progress);
  /// Throws after the first Ctrl-C, because no scan is mapped.
  void show_calibration(double share);
  const std::atomic<bool>& stop() const { return stop_; }

  /// Raises what stopped the run, for runs that have no result: the exception, or KeyboardInterrupt after
  /// Ctrl-C. Needs the interpreter's lock.
  void raise_if_stopped();

  /// Returns `result`, or raises what stopped the run. Needs the interpreter's lock.
  pybind11::object result_or_raise(pybind11::object result);

 private:
  void show(const PythonProgress& progress, bool keeps_result);

  pybind11::object progress_;
  const char* phase_ = "";
  std::chrono::steady_clock::time_point shown_at_{};
  std::atomic<bool> stop_{false};
  bool interrupted_ = false;
  std::exception_ptr error_;
};

/// Adds the class Progress.
void bind_progress(pybind11::module_& module);

}  // namespace psi_slam
