// SPDX-License-Identifier: BSD-3-Clause
// The steps are those of the command psi-slam LOG.
#include "python/map_function.h"

#include <pybind11/stl/filesystem.h>

#include <memory>

#include "psi_slam/user_error.h"
#include "python/python_result.h"
#include "python/python_settings.h"
#include "python/run_watch.h"
#include "session/session_file.h"
#include "session/session_input.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

py::object map_log(const std::filesystem::path& log, const py::object& settings, const py::object& config,
                   const py::object& edits, const py::object& progress) {
  require_log(log);
  BoundSettings bound;
  load_python_settings(bound, config, settings);
  const EditJournal journal = python_edits(edits);
  RunWatch watch(progress);
  const auto shared = std::make_shared<SharedSession>(bound.table.take_warnings());
  try {
    shared->use([&](std::unique_ptr<MappingSession>& session) {
      SessionInput input(log);
      input.calibrate(log_options(bound.settings), [&](double share) {
        if (bound.settings.log.calibrate) watch.show_calibration(share);
      });
      session = std::make_unique<MappingSession>(input, bound.settings);
      session->add_edits(journal);
      session->set_observer([&](const SessionProgress& now) { watch.show(now); });
      session->run(watch.stop());
      session->set_observer({});
    });
  } catch (const UserError&) {
    watch.raise_if_stopped();  // the scans before the stop may be too few for a map
    throw;
  }
  return watch.result_or_raise(py::cast(PythonResult(shared)));
}

}  // namespace

void bind_map(py::module_& module) {
  module.def(
      "map", &map_log, py::arg("log"), py::arg("settings") = py::none(), py::kw_only(),
      py::arg("config") = py::none(), py::arg("edits") = py::none(), py::arg("progress") = py::none(),
      "Maps a log: a CARMEN log, an MRPT rawlog or a ROS bag. Returns a Result.\n\n"
      "settings: dict of \"section.key\" to value, such as {\"map.resolution_m\": 0.1}. None is \"auto\".\n"
      "config:   settings file (.ini); `settings` override it.\n"
      "edits:    file of edits, or a list of its lines.\n"
      "progress: function that receives a Progress at most 20 times per second. An exception that it raises\n"
      "          ends the mapping.\n\n"
      "Raises UserError for an unreadable log and for wrong settings. Ctrl-C ends the mapping soon and "
      "raises\n"
      "Interrupted, whose attribute `result` holds the map of the scans so far. Other Python threads run "
      "while\n"
      "the log is mapped. A log that is damaged on the way gives a Result up to the damage, see\n"
      "Result.broken_off.");
}

}  // namespace psi_slam
