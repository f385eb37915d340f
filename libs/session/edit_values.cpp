// SPDX-License-Identifier: BSD-3-Clause
#include "session/edit_values.h"

#include <algorithm>
#include <cmath>

#include "base/config/nearest_name.h"
#include "base/quotable_text.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

std::string did_you_mean(const std::string& name, const std::vector<std::string>& names) {
  const auto near = nearest_name(name, names);
  return near ? "; did you mean \"" + *near + "\"?" : "";
}

EditValues::EditValues(std::istringstream& words, const std::vector<std::string>& keys) {
  for (std::string word; words >> word;) {
    const std::size_t equals = word.find('=');
    if (equals == std::string::npos)
      throw UserError("\"" + quotable(word) + "\": expected KEY=VALUE. Correct the word");
    const std::string key = word.substr(0, equals);
    if (std::find(keys.begin(), keys.end(), key) == keys.end())
      throw UserError("unknown key \"" + quotable(key) + "\": expected " + name_list(keys) +
                      did_you_mean(key, keys));
    if (!values_.emplace(key, word.substr(equals + 1)).second)
      throw UserError("\"" + key + "\" is given twice, expected once. Remove one of them");
  }
}

const std::string& EditValues::text(const char* key) const {
  const auto found = values_.find(key);
  if (found == values_.end())
    throw UserError(std::string("\"") + key + "\" is missing. Add " + key + "=VALUE");
  return found->second;
}

std::string EditValues::quoted(const char* key) const {
  return quotable(text(key));
}

std::size_t EditValues::whole(const char* key) const {
  const auto value = parse_number(text(key));
  if (!value || *value < 0 || *value > 1e15 || *value != std::floor(*value))
    throw UserError(std::string(key) + "=" + quoted(key) + ": expected a whole number, 0 or more");
  return static_cast<std::size_t>(*value);
}

double EditValues::number(const char* key, decltype(parse_number)* parse) const {
  const auto value = parse(text(key));
  if (!value) throw UserError(std::string(key) + "=" + quoted(key) + ": expected a number");
  return *value;
}

}  // namespace psi_slam
