// SPDX-License-Identifier: BSD-3-Clause
#include "python/python_evaluation.h"

#include <pybind11/numpy.h>
#include <pybind11/stl/filesystem.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_text.h"
#include "map/trajectory/relations_metric.h"
#include "psi_slam/user_error.h"
#include "python/python_result.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

/// Row of Evaluation.errors.
struct ErrorRow {
  double time1_s;
  double time2_s;
  double translation_m;
  double rotation_deg;
  double cartographer_translation_m;
  bool interpolated;
};

bool is_path(const py::object& given) {
  return py::isinstance<py::str>(given) || py::hasattr(given, "__fspath__");
}

using Column = std::vector<double>;

/// Returns the finite numbers of a column. `what` names the argument.
Column column_of(const py::handle& given, const std::string& what, const std::string& name) {
  const auto array = py::array_t<double, py::array::c_style | py::array::forcecast>::ensure(given);
  if (!array) throw UserError(what + ": the column " + name + " holds other values than numbers");
  Column column(array.data(), array.data() + array.size());
  const auto wrong =
      std::find_if(column.begin(), column.end(), [](double number) { return !std::isfinite(number); });
  if (wrong != column.end())
    throw UserError(what + ": " + name + " of row " + std::to_string(wrong - column.begin()) +
                    " (the first row is 0) is " + exact_text(*wrong) +
                    ", expected a finite number. Remove this row");
  return column;
}

/// Returns the columns of a structured array, a pandas table, or a plain array with these columns in this
/// order. `what` names the argument.
template <std::size_t kCount>
std::array<Column, kCount> columns_of(const py::object& given, const std::array<const char*, kCount>& names,
                                      const std::string& what) {
  std::string expected;
  for (const char* name : names) expected += (expected.empty() ? "" : ", ") + std::string(name);
  const bool is_table = py::hasattr(given, "columns");
  const py::object numpy = py::module_::import("numpy");
  const py::object table = is_table ? given : numpy.attr("asarray")(given);
  const py::object fields = is_table ? py::object(table.attr("columns")) : table.attr("dtype").attr("names");
  std::array<Column, kCount> columns;
  for (std::size_t i = 0; i < kCount; ++i) {
    if (!fields.is_none()) {
      const bool is_theta =  // as in trajectory.csv
          !fields.contains(names[i]) && std::string_view(names[i]) == "yaw_rad" &&
          fields.contains("theta_rad");
      const char* const name = is_theta ? "theta_rad" : names[i];
      if (!fields.contains(name))
        throw UserError(what + ": the column " + name + " is missing, expected the columns " + expected);
      columns[i] = column_of(table[name], what, name);
      continue;
    }
    const py::tuple shape = table.attr("shape");
    if (shape.size() != 2 || shape[1].cast<std::size_t>() != kCount)
      throw UserError(what + ": the array has the shape " + std::string(py::str(py::handle(shape))) +
                      ", expected a file, or an array with the columns " + expected);
    columns[i] = column_of(table.attr("T")[py::int_(i)], what, names[i]);
  }
  return columns;
}

TimeUs time_us(double time_s, const std::string& what) {
  if (!(std::abs(time_s) < seconds(kMostTimeUs)))
    throw UserError(what + ": a time is " + exact_text(time_s) + ", expected seconds");
  return std::llround(time_s * 1e6);
}

Trajectory trajectory_from(const py::object& given) {
  if (is_path(given)) return read_trajectory(given.cast<std::filesystem::path>());
  if (py::isinstance<PythonResult>(given)) return given.cast<PythonResult&>().trajectory();
  const auto [times_s, xs_m, ys_m, yaws_rad] =
      columns_of<4>(given, {"time_s", "x_m", "y_m", "yaw_rad"}, "trajectory");
  Trajectory trajectory;
  for (std::size_t i = 0; i < times_s.size(); ++i)
    trajectory.push_back({time_us(times_s[i], "trajectory"), {xs_m.at(i), ys_m.at(i), yaws_rad.at(i)}});
  return trajectory;
}

std::vector<Relation> relations_from(const py::object& given) {
  if (is_path(given)) return read_relations(given.cast<std::filesystem::path>());
  const auto [times1_s, times2_s, xs_m, ys_m, yaws_rad] =
      columns_of<5>(given, {"time1_s", "time2_s", "x_m", "y_m", "yaw_rad"}, "relations");
  std::vector<Relation> relations;
  for (std::size_t i = 0; i < times1_s.size(); ++i)
    relations.push_back({time_us(times1_s[i], "relations"),
                         time_us(times2_s[i], "relations"),
                         {xs_m.at(i), ys_m.at(i), yaws_rad.at(i)}});
  return relations;
}

RelationsMetric evaluate(const py::object& trajectory, const py::object& relations, double max_gap_s) {
  if (!(max_gap_s >= 0))
    throw UserError("max_gap_s is " + exact_text(max_gap_s) + ", expected a number of seconds, 0 or more");
  const Trajectory given_trajectory = trajectory_from(trajectory);
  const std::vector<Relation> given_relations = relations_from(relations);
  const py::gil_scoped_release unlocked;
  return evaluate_relations(given_trajectory, given_relations, max_gap_s);
}

py::object error_array(const RelationsMetric& metric) {
  py::array_t<ErrorRow> rows(static_cast<py::ssize_t>(metric.errors.size()));
  std::transform(metric.errors.begin(), metric.errors.end(), rows.mutable_data(),
                 [](const RelationError& error) {
                   return ErrorRow{seconds(error.relation.time1_us),
                                   seconds(error.relation.time2_us),
                                   error.translation_m,
                                   error.rotation_deg,
                                   error.cartographer_translation_m,
                                   error.interpolated};
                 });
  return py::object(std::move(rows));
}

}  // namespace

void bind_evaluation(py::module_& module) {
  PYBIND11_NUMPY_DTYPE(ErrorRow, time1_s, time2_s, translation_m, rotation_deg, cartographer_translation_m,
                       interpolated);

  py::class_<ErrorSummary>(module, "ErrorSummary", "Summary of the errors of all relations used.")
      .def_readonly("mean", &ErrorSummary::mean, "Mean error.")
      .def_readonly("std", &ErrorSummary::std, "Standard deviation of the population (divided by n).")
      .def_readonly("median", &ErrorSummary::median, "The upper of two middle values.")
      .def_readonly("p95", &ErrorSummary::p95, "The value below which 95 % of the errors lie.")
      .def_readonly("max", &ErrorSummary::max, "Largest error.")
      .def("__repr__", [](const ErrorSummary& summary) {
        return "<psi_slam.ErrorSummary: " + fixed_text(summary.mean, 4) + " ± " + fixed_text(summary.std, 4) +
               ">";
      });

  py::class_<RelationsMetric>(
      module, "Evaluation",
      "Accuracy of a trajectory: the relations metric of the Freiburg SLAM benchmark\n"
      "(Kümmerle et al. 2009), and the variant of Cartographer's tool.")
      .def_property_readonly(
          "used", [](const RelationsMetric& metric) { return metric.exact + metric.interpolated; },
          "Number of relations used.")
      .def_readonly("exact", &RelationsMetric::exact, "Relations with both times in the trajectory.")
      .def_readonly("interpolated", &RelationsMetric::interpolated,
                    "Relations with at least one pose interpolated.")
      .def_readonly("skipped", &RelationsMetric::skipped,
                    "Relations outside the trajectory or in a long gap.")
      .def_readonly("translation_abs_m", &RelationsMetric::translation_abs_m,
                    "Translational errors, metres: an ErrorSummary.")
      .def_readonly("translation_sq_m2", &RelationsMetric::translation_sq_m2,
                    "Squared translational errors, m^2.")
      .def_readonly("rotation_abs_deg", &RelationsMetric::rotation_abs_deg, "Rotational errors, degrees.")
      .def_readonly("rotation_sq_deg2", &RelationsMetric::rotation_sq_deg2,
                    "Squared rotational errors, deg^2.")
      .def_readonly("cartographer_translation_abs_m", &RelationsMetric::cartographer_translation_abs_m,
                    "Translational errors as Cartographer's tool defines them, metres.")
      .def_readonly("cartographer_translation_sq_m2", &RelationsMetric::cartographer_translation_sq_m2,
                    "Their squares, m^2.")
      .def_property_readonly(
          "errors", &error_array,
          "Error of each relation used: a structured array with the fields time1_s, time2_s,\n"
          "translation_m, rotation_deg, cartographer_translation_m and interpolated.")
      .def("__repr__", [](const RelationsMetric& metric) {
        return "<psi_slam.Evaluation: " + counted(metric.exact + metric.interpolated, "relation") + ", " +
               fixed_text(metric.translation_abs_m.mean, 4) + " m, " +
               fixed_text(metric.rotation_abs_deg.mean, 3) + " deg>";
      });

  module.def(
      "evaluate", &evaluate, py::arg("trajectory"), py::arg("relations"), py::kw_only(),
      py::arg("max_gap_s") = kMaxGap_s,
      "Compares a trajectory with known relative poses, as psi-slam eval does. Returns an Evaluation.\n\n"
      "trajectory: a Result; the path of a file that psi-slam eval reads; or an array or pandas table\n"
      "            with the columns time_s, x_m, y_m, yaw_rad (or theta_rad, as in trajectory.csv).\n"
      "relations:  the path of a file of relations; or an array or pandas table with the columns\n"
      "            time1_s, time2_s, x_m, y_m, yaw_rad.\n"
      "max_gap_s:  longest gap between two poses that is interpolated, seconds.\n\n"
      "Raises UserError if no relation can be used.");
}

}  // namespace psi_slam
