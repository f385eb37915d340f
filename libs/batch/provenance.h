// SPDX-License-Identifier: BSD-3-Clause
// Where figures come from: the log and the machine.
#pragma once

#include <optional>
#include <string>

namespace psi_slam {

/// Name of the log that `file` is, without the ending of a log file: "intel" for "intel.clf.gz". Empty for
/// other endings.
std::optional<std::string> log_name_of(const std::string& file);

/// Processor and number of processors of this machine: "AMD EPYC, 2 processors".
std::string machine_text();

}  // namespace psi_slam
