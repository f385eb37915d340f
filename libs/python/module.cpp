// SPDX-License-Identifier: BSD-3-Clause
// The Python module psi_slam._core. The package psi_slam exports its names.
#include <pybind11/pybind11.h>

#include "psi_slam/version.h"
#include "python/errors.h"
#include "python/map_function.h"
#include "python/python_evaluation.h"
#include "python/python_mapper.h"
#include "python/python_result.h"
#include "python/python_scan.h"
#include "python/run_watch.h"

PYBIND11_MODULE(_core, module) {
  pybind11::options options;
  options.disable_function_signatures();  // _core.pyi has them
  module.doc() = "Implementation of the package psi_slam.";
  module.attr("__version__") = PSI_SLAM_VERSION;
  psi_slam::bind_errors(module);
  psi_slam::bind_progress(module);
  psi_slam::bind_result(module);
  psi_slam::bind_map(module);
  psi_slam::bind_scan(module);
  psi_slam::bind_mapper(module);
  psi_slam::bind_evaluation(module);
}
