// SPDX-License-Identifier: BSD-3-Clause
#include "python/run_watch.h"

#include <pybind11/stl.h>

#include <array>
#include <string_view>
#include <utility>

#include "python/errors.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

constexpr std::chrono::milliseconds kPeriod{50};

const char* name_of(SessionProgress::Phase phase) {
  constexpr std::array<const char*, 4> kNames{"mapping", "prior map", "final search", "writing"};
  return kNames.at(static_cast<std::size_t>(phase));
}

}  // namespace

RunWatch::RunWatch(py::object progress) : progress_(std::move(progress)) {
  if (!progress_.is_none() && !PyCallable_Check(progress_.ptr()))
    throw py::type_error("progress: expected None or a function that takes a psi_slam.Progress");
}

void RunWatch::show(const SessionProgress& progress) {
  show({name_of(progress.phase), progress.share, progress.scans, progress.scans_per_s, progress.elapsed_s,
        progress.remaining_s},
       true);
}

void RunWatch::show_calibration(double share) {
  PythonProgress progress;
  progress.phase = "calibrating";
  progress.share = share;
  show(progress, false);
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
}

void RunWatch::show(const PythonProgress& progress, bool keeps_result) {
  const auto now = std::chrono::steady_clock::now();
  const bool is_new_phase = std::string_view(phase_) != progress.phase;
  if (!is_new_phase && now - shown_at_ < kPeriod) return;
  phase_ = progress.phase;
  shown_at_ = now;
  const py::gil_scoped_acquire lock;
  try {
    if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    if (!error_ && !progress_.is_none()) progress_(progress);
  } catch (const py::error_already_set& error) {
    const bool is_interrupt = error.matches(PyExc_KeyboardInterrupt);
    if (is_interrupt && (interrupted_ || !keeps_result)) throw;
    stop_ = true;
    interrupted_ = interrupted_ || is_interrupt;
    if (!is_interrupt) error_ = std::current_exception();
  }
}

void RunWatch::raise_if_stopped() {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (!interrupted_) return;
  PyErr_SetNone(PyExc_KeyboardInterrupt);
  throw py::error_already_set();
}

py::object RunWatch::result_or_raise(py::object result) {
  if (error_) std::rethrow_exception(std::exchange(error_, nullptr));
  if (interrupted_) raise_interrupted(result);
  return result;
}

void bind_progress(py::module_& module) {
  py::class_<PythonProgress>(module, "Progress", "Progress of a run, as the function `progress` receives it.")
      .def_property_readonly(
          "phase", [](const PythonProgress& progress) { return progress.phase; },
          "Part of the work: \"calibrating\", \"mapping\", \"prior map\" or \"final search\".")
      .def_readonly("share", &PythonProgress::share, "Completed share of the phase, in [0, 1].")
      .def_readonly("scans", &PythonProgress::scans, "Number of scans mapped so far.")
      .def_readonly("scans_per_s", &PythonProgress::scans_per_s, "Scans mapped per second of work.")
      .def_readonly("elapsed_s", &PythonProgress::elapsed_s, "Time of work, seconds.")
      .def_readonly("remaining_s", &PythonProgress::remaining_s,
                    "Estimated time left in the phase, seconds; None while it is unknown.");
}

}  // namespace psi_slam
