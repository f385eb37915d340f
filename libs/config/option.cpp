// SPDX-License-Identifier: BSD-3-Clause
#include "config/option.h"

#include <array>
#include <cmath>
#include <utility>

#include "base/number_text.h"

namespace psi_slam {
namespace {

constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kUnitWords{
    {{"m", "metres"}, {"deg", "degrees"}, {"s", "seconds"}, {"ms", "milliseconds"}}};

std::string of_unit(const std::string& unit) {
  if (unit.empty()) return "";
  for (const auto& [symbol, word] : kUnitWords)
    if (symbol == unit) return " of " + std::string(word);
  const bool is_word = unit.find_first_of("/^ ") == std::string::npos && unit.size() > 3;
  return (is_word ? " of " : " in ") + unit;
}

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

std::string number_expectation(const Option& option) {
  std::string text = option.type == OptionType::kInteger ? "a whole number" : "a number";
  text += of_unit(option.unit);
  const std::string range = option.range.words();
  const bool range_is_aside = range.find(" or ") != std::string::npos;
  return range.empty() ? text : text + (range_is_aside ? ", " : " ") + range;
}

std::string number_values(const Option& option) {
  std::string text = option.type == OptionType::kInteger ? "whole number" : "number";
  if (!option.unit.empty()) text = option.unit;
  const std::string range = option.range.words();
  return range.empty() ? text : text + ", " + range;
}

}  // namespace

bool NumberRange::contains(double value) const {
  if (!std::isfinite(value)) return false;
  if (min && !(min->inclusive ? value >= min->value : value > min->value)) return false;
  if (max && !(max->inclusive ? value <= max->value : value < max->value)) return false;
  return true;
}

std::string NumberRange::words() const {
  if (!min && !max) return "";
  if (!max) return min->inclusive ? exact_text(min->value) + " or more" : "above " + exact_text(min->value);
  if (!min) return max->inclusive ? exact_text(max->value) + " or less" : "below " + exact_text(max->value);
  if (min->inclusive && max->inclusive)
    return "between " + exact_text(min->value) + " and " + exact_text(max->value);
  return (min->inclusive ? "at least " : "above ") + exact_text(min->value) + " and " +
         (max->inclusive ? "at most " : "below ") + exact_text(max->value);
}

std::string Option::expectation() const {
  if (type == OptionType::kText) return "a text of one line";
  if (type != OptionType::kInteger && type != OptionType::kNumber) return values();
  return (may_be_auto ? "auto or " : "") + number_expectation(*this);
}

std::string Option::values() const {
  switch (type) {
    case OptionType::kFlag:
      return "true or false";
    case OptionType::kInteger:
    case OptionType::kNumber:
      return number_values(*this) + (may_be_auto ? "; or auto" : "");
    case OptionType::kChoice:
      return "one of " + joined(choices);
    case OptionType::kText:
      return "text";
  }
  return "";
}

}  // namespace psi_slam
