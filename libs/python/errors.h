// SPDX-License-Identifier: BSD-3-Clause
// Exceptions of the Python module.
#pragma once

#include <pybind11/pybind11.h>

#include <string>
#include <vector>

namespace psi_slam {

/// Adds the exceptions UserError, SystemFailure and Interrupted to the module. C++ exceptions of the first
/// two names become theirs, with the same text.
void bind_errors(pybind11::module_& module);

/// Raises psi_slam.Interrupted with `result`, the map of the scans before the interrupt.
[[noreturn]] void raise_interrupted(const pybind11::object& result);

/// Returns a text for Python. Bytes that are not UTF-8, as in names of files, survive as in os.fsdecode().
pybind11::str python_text(const std::string& text);
pybind11::list python_texts(const std::vector<std::string>& texts);

}  // namespace psi_slam
