// SPDX-License-Identifier: BSD-3-Clause
// What the judges of a log share: the list of findings and the wording of numbers.
#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "base/number_text.h"
#include "logs/doctor/input_doctor.h"

namespace psi_slam {

/// Collects the findings that follow from one diagnosis of a log.
class FindingList {
 public:
  explicit FindingList(const LogDiagnosis& diagnosis) : diagnosis_(diagnosis), facts_(diagnosis.facts) {}

 protected:
  void note(const char* code, std::string sentence, std::string remedy = {}) {
    findings_.push_back({code, Severity::kNote, std::move(sentence), std::move(remedy)});
  }
  void warn(const char* code, std::string sentence, std::string remedy) {
    findings_.push_back({code, Severity::kWarning, std::move(sentence), std::move(remedy)});
  }

  /// Time of a frame for messages: "12.34 s into the log".
  std::string moment(std::size_t frame) const {
    return fixed(seconds(diagnosis_.marks[frame].time_us - facts_.time.first_us), 2) + " s into the log";
  }

  static std::string fixed(double value, int decimals) {
    return fixed_text(value + 0.0, decimals);  // adding 0.0 turns -0 into 0
  }
  static std::string percent(double share) { return fixed(100 * share, share < 0.01 ? 2 : 1) + " %"; }
  static double share_of(std::size_t part, std::size_t whole) {
    return whole == 0 ? 0 : static_cast<double>(part) / static_cast<double>(whole);
  }

  const LogDiagnosis& diagnosis_;
  const LogFacts& facts_;
  std::vector<Finding> findings_;
};

}  // namespace psi_slam
