// SPDX-License-Identifier: BSD-3-Clause
// The key=value pairs of a line in a file of edits.
#pragma once

#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/number_text.h"

namespace psi_slam {

/// Returns "; did you mean ...?" if one of `names` is close to `name`, otherwise "".
std::string did_you_mean(const std::string& name, const std::vector<std::string>& names);

/// All functions throw UserError, without file and line, for texts that they do not accept.
class EditValues {
 public:
  /// Reads the rest of a line, whose keys must be among `keys`.
  EditValues(std::istringstream& words, const std::vector<std::string>& keys);

  bool has(const char* key) const { return values_.count(key) != 0; }

  const std::string& text(const char* key) const;

  /// The text of a key for a message, see quotable().
  std::string quoted(const char* key) const;

  /// A whole number, 0 or more.
  std::size_t whole(const char* key) const;

  double number(const char* key, decltype(parse_number)* parse = parse_number) const;

 private:
  std::map<std::string, std::string> values_;
};

}  // namespace psi_slam
