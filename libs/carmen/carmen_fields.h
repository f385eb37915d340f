// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <mrpt/math/TPose2D.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "compression/line_reader.h"
#include "psi_slam/time_stamp.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

/// A line that is not what its message should be. Its text names file, line, message and what was expected.
class MalformedLine : public UserError {
 public:
  using UserError::UserError;
};

/// Takes the fields of one line of a CARMEN log from left to right. Each call throws MalformedLine when the
/// next field is missing or is something else; a line that the end of the file cuts short is named as such.
class CarmenFields {
 public:
  /// Takes the message's name, which may be empty (a blank line).
  CarmenFields(std::string_view line, const LineReader& lines);

  std::string_view message() const { return message_; }

  std::string_view word(const char* what);
  double number(const char* what);
  std::size_t count(const char* what);
  TimeUs time(const char* what);
  mrpt::math::TPose2D pose(const char* what);

  /// `count` ranges, metres; "nan" and "inf" are numbers here.
  std::vector<float> ranges(std::size_t count);
  void skip_numbers(std::size_t count, const char* what);

  /// The end of every line, `ipc_timestamp host logger_timestamp`: the first of them.
  TimeUs stamps();

  [[noreturn]] void fail(const std::string& found_and_expected) const;

 private:
  std::string_view next_field();
  [[noreturn]] void fail_field(std::string_view field, const std::string& expected) const;

  std::string_view rest_;
  std::string_view message_;
  const LineReader& lines_;
};

}  // namespace psi_slam
