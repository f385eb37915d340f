// SPDX-License-Identifier: BSD-3-Clause
#include "python/errors.h"

#include <exception>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace py = pybind11;

// The module holds these classes until the interpreter ends.
PyObject* user_error = nullptr;
PyObject* system_failure = nullptr;
PyObject* interrupted = nullptr;

PyObject* add_exception(py::module_& module, const char* name, PyObject* base, const char* doc) {
  const std::string full_name = std::string("psi_slam.") + name;
  PyObject* const made = PyErr_NewExceptionWithDoc(full_name.c_str(), doc, base, nullptr);
  if (!made) throw py::error_already_set();
  module.attr(name) = py::handle(made);
  return made;
}

// pybind11 takes a function of this type.
// NOLINTNEXTLINE(performance-unnecessary-value-param)
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const UserError& error) {
    PyErr_SetObject(user_error, python_text(error.what()).ptr());
  } catch (const SystemFailure& error) {
    PyErr_SetObject(system_failure, python_text(error.what()).ptr());
  }
}

}  // namespace

void bind_errors(py::module_& module) {
  user_error = add_exception(
      module, "UserError", PyExc_ValueError,
      "A mistake that the user can correct, such as a missing log or an unknown setting. The text says what\n"
      "is wrong, where, what was expected and what to do next, in the words of the program psi-slam.");
  system_failure = add_exception(module, "SystemFailure", PyExc_RuntimeError,
                                 "A failure of the system, such as a full disk.");
  interrupted = add_exception(module, "Interrupted", PyExc_KeyboardInterrupt,
                              "Raised after Ctrl-C while mapping. Its attribute `result` is the Result of "
                              "the scans that were mapped\n"
                              "before. A second Ctrl-C raises KeyboardInterrupt without a result.");
  const py::cpp_function result([](const py::handle& self) { return self.attr("_result"); });
  py::handle(interrupted).attr("_result") = py::none();
  py::handle(interrupted).attr("result") =
      py::module_::import("builtins")
          .attr("property")(result, py::none(), py::none(),
                            "The Result of the scans that were mapped before.");
  py::register_exception_translator(&translate);
}

void raise_interrupted(const py::object& result) {
  const py::object raised =
      py::handle(interrupted)("interrupted: the result holds the scans and loops found so far");
  raised.attr("_result") = result;
  PyErr_SetObject(interrupted, raised.ptr());
  throw py::error_already_set();
}

py::str python_text(const std::string& text) {
  PyObject* const decoded =
      PyUnicode_DecodeFSDefaultAndSize(text.data(), static_cast<Py_ssize_t>(text.size()));
  if (!decoded) throw py::error_already_set();
  return py::reinterpret_steal<py::str>(decoded);
}

py::list python_texts(const std::vector<std::string>& texts) {
  py::list list;
  for (const std::string& text : texts) list.append(python_text(text));
  return list;
}

}  // namespace psi_slam
