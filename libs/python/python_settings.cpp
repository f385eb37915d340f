// SPDX-License-Identifier: BSD-3-Clause
#include "python/python_settings.h"

#include <pybind11/stl/filesystem.h>

#include <string>

#include "base/number_text.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

std::string type_name(const py::handle& value) {
  return py::str(py::type::handle_of(value).attr("__name__"));
}

/// Returns a path. `name` names the argument.
std::filesystem::path path_of(const py::handle& given, const std::string& name, const std::string& expected) {
  try {
    return given.cast<std::filesystem::path>();
  } catch (const py::cast_error&) {
    throw UserError(name + " is of type " + type_name(given) + ", expected " + expected);
  }
}

bool is_path_object(const py::handle& value) {
  return py::hasattr(value, "__fspath__");
}

/// Returns the value as the text of a settings file.
std::string option_text(const std::string& name, const py::handle& value) {
  if (value.is_none()) return "auto";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (is_path_object(value)) return path_of(value, "settings: " + name, "a path").string();
  if (py::isinstance<py::bool_>(value) || py::isinstance(value, py::module_::import("numpy").attr("bool_")))
    return value.attr("__bool__")().cast<bool>() ? "true" : "false";
  if (PyIndex_Check(value.ptr())) return py::str(value.attr("__index__")());
  if (py::hasattr(value, "__float__")) return exact_text(value.attr("__float__")().cast<double>());
  throw UserError("settings: " + name + " is of type " + type_name(value) +
                  ", expected a text, a path, a number, a bool, or None for auto");
}

}  // namespace

void load_python_settings(BoundSettings& bound, const py::object& config, const py::object& settings) {
  bound.load(
      config.is_none() ? std::filesystem::path() : path_of(config, "config", "the path of a settings file"),
      {});
  if (!settings.is_none()) {
    if (!py::hasattr(settings, "items"))
      throw UserError("settings: expected a dict such as {\"map.resolution_m\": 0.1}, not a value of type " +
                      type_name(settings));
    for (const py::handle item : settings.attr("items")()) {
      const auto pair = item.cast<py::tuple>();
      const std::string name = py::str(pair[0]);
      bound.table.set_any(name, option_text(name, pair[1]), "settings");
    }
  }
  check(bound.settings);
}

EditJournal python_edits(const py::object& edits) {
  if (edits.is_none()) return {};
  const std::string expected = "the path of a file of edits, or a list of its lines";
  if (py::isinstance<py::str>(edits) || is_path_object(edits))
    return EditJournal::read(path_of(edits, "edits", expected));
  if (!py::hasattr(edits, "__iter__"))
    throw UserError("edits is of type " + type_name(edits) + ", expected " + expected);
  std::string text;
  for (const py::handle line : edits) {
    try {
      text += line.cast<std::string>() + '\n';
    } catch (const py::cast_error&) {
      throw UserError("edits: a line is of type " + type_name(line) + ", expected a text");
    }
  }
  return EditJournal::parse(text, "edits");
}

}  // namespace psi_slam
