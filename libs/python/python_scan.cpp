// SPDX-License-Identifier: BSD-3-Clause
#include "python/python_scan.h"

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "logs/frames/laser_readings.h"
#include "logs/frames/pose_operations.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

std::string shape_text(const py::array& array) {
  return py::str(array.attr("shape"));
}

/// Returns an array of one dimension. `name` names the argument.
template <class T>
std::vector<T> numbers_of(const py::object& given, const std::string& name) {
  const auto array = py::array_t<T, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) {
    PyErr_Clear();
    throw UserError("Scan: " + name + " is no array of numbers. Pass a NumPy array or a list of numbers");
  }
  if (array.ndim() != 1)
    throw UserError("Scan: " + name + " has the shape " + shape_text(array) +
                    ", expected an array of one dimension with one value for each beam");
  return std::vector<T>(array.data(), array.data() + array.size());
}

std::vector<float> even_bearings(std::size_t beams, double angle_min_rad, double angle_increment_rad) {
  std::vector<float> bearings_rad(beams);
  for (std::size_t i = 0; i < beams; ++i)
    bearings_rad[i] = static_cast<float>(angle_min_rad + static_cast<double>(i) * angle_increment_rad);
  return bearings_rad;
}

void require_above_zero(double value, const char* name) {
  if (!(value > 0))
    throw UserError("Scan: " + std::string(name) + " is " + exact_text(value) +
                    ", expected a number of metres above 0");
}

/// Returns three finite numbers as a pose.
std::optional<mrpt::math::TPose2D> pose_of(const py::handle& given) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) PyErr_Clear();
  if (!array || array.size() != 3) return std::nullopt;
  const double* const pose = array.data();
  if (!std::all_of(pose, pose + 3, [](double number) { return std::isfinite(number); })) return std::nullopt;
  mrpt::math::TPose2D found(pose[0], pose[1], pose[2]);
  if (std::abs(found.phi) > M_PI)
    found.normalizePhi();  // only if necessary: wrapping may change the last digit
  return found;
}

PythonScan make_scan(const py::object& ranges_m, double time_s, double max_range_m,
                     std::optional<double> angle_min_rad, std::optional<double> angle_increment_rad,
                     const py::object& bearings_rad, double min_range_m, const py::object& mount) {
  PythonScan made;
  if (!(std::abs(time_s) < seconds(kMostTimeUs)))
    throw UserError("Scan: time_s is " + exact_text(time_s) + ", expected a time in seconds");
  made.time_us = std::llround(time_s * 1e6);
  require_above_zero(max_range_m, "max_range_m");
  if (!(min_range_m >= 0 && min_range_m < max_range_m))
    throw UserError("Scan: min_range_m is " + exact_text(min_range_m) +
                    ", expected a number of metres from 0 to below max_range_m, which is " +
                    exact_text(max_range_m));
  made.max_range_m = max_range_m;
  made.min_range_m = min_range_m;
  made.scan.ranges_m = numbers_of<float>(ranges_m, "ranges_m");
  const std::size_t beams = made.scan.ranges_m.size();
  if (beams == 0) throw UserError("Scan: ranges_m is empty, expected one range for each beam");
  const bool has_angles = angle_min_rad && angle_increment_rad;
  if (has_angles != bearings_rad.is_none() || (!has_angles && (angle_min_rad || angle_increment_rad)))
    throw UserError(
        "Scan: state the beams either by angle_min_rad and angle_increment_rad, or by bearings_rad");
  std::vector<float> bearings = has_angles ? even_bearings(beams, *angle_min_rad, *angle_increment_rad)
                                           : numbers_of<float>(bearings_rad, "bearings_rad");
  if (bearings.size() != beams)
    throw UserError("Scan: " + std::to_string(bearings.size()) + " bearings for " + std::to_string(beams) +
                    " ranges, expected one bearing for each range");
  const bool are_finite =
      std::all_of(bearings.begin(), bearings.end(), [](float bearing) { return std::isfinite(bearing); });
  if (!are_finite) throw UserError("Scan: a beam bearing is not finite, expected radians");
  const auto [least, most] = std::minmax_element(bearings.begin(), bearings.end());
  const double span_rad = static_cast<double>(*most) - static_cast<double>(*least);
  const double steps = static_cast<double>(std::max<std::size_t>(beams, 2) - 1);
  if (const auto fault = fault_of_beams(beams, static_cast<double>(*least), span_rad / steps))
    throw UserError("Scan: " + *fault);
  made.scan.bearings_rad = std::make_shared<const std::vector<float>>(std::move(bearings));
  const auto robot_T_laser = pose_of(mount);
  if (!robot_T_laser || !is_possible_mount(*robot_T_laser))
    throw UserError("Scan: mount is " + std::string(py::str(mount)) +
                    ", expected (x, y, yaw) of the laser on the robot: metres up to 100, and radians");
  made.scan.robot_T_laser = *robot_T_laser;
  return made;
}

}  // namespace

Frame frame_of(const PythonScan& scan, const py::object& odometry, const LogOptions& options) {
  Frame frame;
  frame.time_us = scan.time_us;
  frame.scan = scan.scan;
  limit_ranges(frame.scan, options, scan.max_range_m, scan.min_range_m);
  frame.has_odometry = !odometry.is_none();
  if (!frame.has_odometry) return frame;
  const auto odom_T_robot = pose_of(odometry);
  if (!odom_T_robot || !is_possible_odometry(*odom_T_robot))
    throw UserError(
        "Mapper.add: odometry is " + std::string(py::str(odometry)) +
        ", expected None or (x, y, yaw) of the robot: finite numbers, metres up to 10,000 km and radians");
  frame.odom_T_robot = *odom_T_robot;
  return frame;
}

void bind_scan(py::module_& module) {
  py::class_<PythonScan>(
      module, "Scan",
      "One planar laser scan.\n\n"
      "ranges_m:    array with one range for each beam, metres. At or beyond max_range_m, or\n"
      "             infinite: no return. 0, negative or NaN: invalid.\n"
      "time_s:      time of the scan, seconds.\n"
      "max_range_m: largest range that the laser measures, metres.\n"
      "angle_min_rad, angle_increment_rad: bearing of the first beam, and angle to the next\n"
      "             beam, radians, counter-clockwise positive, as in sensor_msgs/LaserScan.\n"
      "bearings_rad: bearing of each beam instead, for lasers with other beams.\n"
      "min_range_m: shorter ranges are invalid, metres.\n"
      "mount:       pose (x, y, yaw) of the laser on the robot, metres and radians.\n\n"
      "All beams count as measured at time_s. Raises UserError for arguments that contradict\n"
      "each other.")
      .def(py::init(&make_scan), py::arg("ranges_m"), py::kw_only(), py::arg("time_s"),
           py::arg("max_range_m"), py::arg("angle_min_rad") = py::none(),
           py::arg("angle_increment_rad") = py::none(), py::arg("bearings_rad") = py::none(),
           py::arg("min_range_m") = 0.0, py::arg("mount") = py::make_tuple(0.0, 0.0, 0.0))
      .def_property_readonly(
          "time_s", [](const PythonScan& scan) { return seconds(scan.time_us); },
          "Time of the scan, seconds, rounded to microseconds.")
      .def("__len__", [](const PythonScan& scan) { return scan.scan.ranges_m.size(); })
      .def("__repr__", [](const PythonScan& scan) {
        return "<psi_slam.Scan: " + counted(scan.scan.ranges_m.size(), "beam") + " at " +
               format_seconds(scan.time_us) + " s>";
      });
}

}  // namespace psi_slam
