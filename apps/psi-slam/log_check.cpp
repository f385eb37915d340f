// SPDX-License-Identifier: BSD-3-Clause
#include "log_check.h"

#include <nlohmann/json.hpp>
#include <ostream>

#include "doctor/diagnosis_report.h"
#include "doctor/input_doctor.h"

namespace psi_slam {

std::string check_log(const std::filesystem::path& log, const LogOptions& options, bool as_json,
                      std::ostream& out) {
  const LogDiagnosis diagnosis = diagnose(log, options);
  if (as_json) {
    using Json = nlohmann::ordered_json;
    out << to_json(diagnosis).dump(1, ' ', false, Json::error_handler_t::replace) << '\n';
  } else {
    for (const std::string& line : describe(diagnosis)) out << line << '\n';
  }
  return diagnosis.facts.broken_off;
}

}  // namespace psi_slam
