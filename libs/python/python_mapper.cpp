// SPDX-License-Identifier: BSD-3-Clause
// A mapper for scans of a program: a session that reads a queue, as psi-slam live reads a robot.
#include "python/python_mapper.h"

#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "base/number_text.h"
#include "base/scope_exit.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"
#include "python/python_result.h"
#include "python/python_scan.h"
#include "python/python_settings.h"
#include "python/run_watch.h"
#include "python/scan_queue.h"
#include "session/session_input.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

/// The class psi_slam.Pose.
struct PythonPose {
  TimeUs time_us = 0;
  mrpt::math::TPose2D map_T_robot;
  bool matched = false;
  std::optional<Eigen::Matrix3d> covariance;
};

/// Throws UserError for settings that read logs and would have no effect on scans of a program.
void check_settings_of_logs(const OptionTable& table) {
  for (const OptionSection& section : table.sections()) {
    if (section.name != "log") continue;
    for (const Option& option : section.options)
      if (option.key != "min_range_m" && option.key != "max_range_m" && option.text() != option.default_text)
        throw UserError("settings: " + option.name() +
                        " applies to logs, not to scans that a program adds. Remove it, and state the laser "
                        "in psi_slam.Scan");
  }
}

class PythonMapper {
 public:
  PythonMapper(const py::object& settings, const py::object& config, const py::object& edits,
               const std::string& name, bool estimate_covariance) {
    load_python_settings(bound_, config, settings);
    check_settings_of_logs(bound_.table);
    const EditJournal journal = python_edits(edits);
    bound_.settings.mapper.estimates_covariance = estimate_covariance;
    session_ = std::make_shared<SharedSession>(bound_.table.take_warnings());
    bool is_open = false;
    const ScopeExit close([&] {
      if (!is_open) queue_->close();  // a session that an error destroys may wait for scans
    });
    session_->use([&](std::unique_ptr<MappingSession>& session) {
      const SessionInput input(
          name, [queue = queue_](const LogOptions&) { return std::make_unique<QueuedScans>(queue); });
      session = std::make_unique<MappingSession>(input, bound_.settings);
      session->add_edits(journal);
      session->set_pose_observer([this, mapped = session.get()](const FrameRecord& record) {
        newest_ = {record.time_us, record.map_T_robot, record.match == ScanMatch::kMatched,
                   mapped->mapper().newest_covariance()};
      });
    });
    is_open = true;
  }
  ~PythonMapper() { queue_->close(); }
  PythonMapper(const PythonMapper&) = delete;
  PythonMapper& operator=(const PythonMapper&) = delete;

  PythonPose add(const PythonScan& scan, const py::object& odometry) {
    Frame frame = frame_of(scan, odometry, bound_.settings.log);
    return session_->use([&](std::unique_ptr<MappingSession>& session) {
      require_open();
      share_bearings(frame.scan);
      PythonPose predicted{frame.time_us, newest_.map_T_robot, false, {}};
      std::optional<mrpt::math::TPose2D> odom_T_robot;
      if (frame.has_odometry) odom_T_robot = frame.odom_T_robot;
      if (odom_T_robot && odom_T_newest_)
        predicted.map_T_robot = compose(newest_.map_T_robot, between(*odom_T_newest_, *odom_T_robot));
      const bool is_new = queue_->push(std::move(frame));
      if (is_new) session->step();
      ++scans_;
      if (!is_new) return predicted;
      odom_T_newest_ = odom_T_robot;
      return newest_;
    });
  }

  py::object finish(const py::object& progress) {
    RunWatch watch(progress);
    try {
      session_->use([&](std::unique_ptr<MappingSession>& session) {
        if (session->finished()) return;
        require_open();
        if (scans_ == 0) throw UserError("Mapper: no scan was added. Call add() first");
        finished_ = true;
        queue_->close();
        session->set_observer([&](const SessionProgress& now) { watch.show(now); });
        const ScopeExit leave([&] { session->set_observer({}); });
        session->finish(watch.stop());
      });
    } catch (const UserError&) {
      watch.raise_if_stopped();
      throw;
    }
    if (!result_) result_ = py::cast(PythonResult(session_));
    return watch.result_or_raise(result_);
  }

  std::string repr() const { return "<psi_slam.Mapper: " + counted(scans_, "scan") + ">"; }

 private:
  void require_open() const {
    if (finished_)
      throw UserError("Mapper: finish() was called, so no more scans can be mapped. Make a new Mapper");
  }

  /// Replaces the bearings by those of the scan before if they are equal, to save memory.
  void share_bearings(LaserScan& scan) {
    if (bearings_rad_ && *bearings_rad_ == *scan.bearings_rad) scan.bearings_rad = bearings_rad_;
    bearings_rad_ = scan.bearings_rad;
  }

  BoundSettings bound_;
  std::shared_ptr<ScanQueue> queue_ = std::make_shared<ScanQueue>();
  std::shared_ptr<SharedSession> session_;
  BeamBearings bearings_rad_;                         ///< of the last scan
  PythonPose newest_;                                 ///< of the last scan that was mapped
  std::optional<mrpt::math::TPose2D> odom_T_newest_;  ///< odometry of that scan
  std::atomic<std::size_t> scans_{0};                 ///< number of scans added
  bool finished_ = false;
  py::object result_;  ///< made by finish()
};

py::object covariance_array(const PythonPose& pose) {
  if (!pose.covariance) return py::none();
  py::array_t<double> array({3, 3});
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column)
      array.mutable_at(row, column) = (*pose.covariance)(row, column);
  return py::object(std::move(array));
}

}  // namespace

void bind_mapper(py::module_& module) {
  py::class_<PythonPose>(
      module, "Pose",
      "Pose of the robot in the map when its scan was mapped. Later loops correct it; the\n"
      "poses of the finished map are in Result.poses.")
      .def_property_readonly(
          "time_s", [](const PythonPose& pose) { return seconds(pose.time_us); },
          "Time of the scan, seconds.")
      .def_property_readonly(
          "x_m", [](const PythonPose& pose) { return pose.map_T_robot.x; }, "Position in the map, metres.")
      .def_property_readonly(
          "y_m", [](const PythonPose& pose) { return pose.map_T_robot.y; }, "Position in the map, metres.")
      .def_property_readonly(
          "yaw_rad", [](const PythonPose& pose) { return pose.map_T_robot.phi; },
          "Heading in the map, radians, counter-clockwise.")
      .def_readonly("matched", &PythonPose::matched,
                    "Whether the scan was matched with the map. False: the pose is a prediction.")
      .def_property_readonly(
          "covariance", &covariance_array,
          "Covariance of (x, y, yaw), an array of the shape (3, 3) in m^2, m rad and rad^2,\n"
          "or None while it is unknown; see the argument estimate_covariance of Mapper.")
      .def("__repr__", [](const PythonPose& pose) {
        return "<psi_slam.Pose: " + pose.map_T_robot.asString() + " at " + format_seconds(pose.time_us) +
               " s>";
      });

  py::class_<PythonMapper>(
      module, "Mapper",
      "Maps scans that a program brings, one by one.\n\n"
      "settings, config, edits: as for map(). Of the settings [log], only log.min_range_m and\n"
      "    log.max_range_m have a meaning; the others raise UserError.\n"
      "name: name of the source in the files of the map.\n"
      "estimate_covariance: whether add() returns the covariance of each pose.\n\n"
      "The finished map does not depend on when the scans are added. A Mapper may be used by several "
      "threads.")
      .def(py::init<const py::object&, const py::object&, const py::object&, const std::string&, bool>(),
           py::arg("settings") = py::none(), py::kw_only(), py::arg("config") = py::none(),
           py::arg("edits") = py::none(), py::arg("name") = "python", py::arg("estimate_covariance") = false)
      .def(
          "add", &PythonMapper::add, py::arg("scan"), py::arg("odometry") = py::none(),
          "Maps a Scan and returns the Pose of the robot. Leaves out a scan whose readings repeat those of\n"
          "an earlier one although odometry moved; its Pose is predicted by odometry.\n\n"
          "odometry: pose (x, y, yaw) of the robot by odometry at the time of the scan, metres and radians,\n"
          "          in a frame that stays the same; or None if the motion is unknown.")
      .def("finish", &PythonMapper::finish, py::arg("progress") = py::none(),
           "Closes the last loops, refines all poses and returns the Result.\n\n"
           "progress: as for map(). Ctrl-C skips the rest of this work and raises Interrupted with the "
           "result.\n"
           "          An exception that it raises skips the rest, too. It may not use the Mapper.\n\n"
           "A further call returns the same Result, also after such an exception. Raises UserError if no\n"
           "scan was added.")
      .def("__repr__", &PythonMapper::repr);
}

}  // namespace psi_slam
