// SPDX-License-Identifier: BSD-3-Clause
#include "config/option.h"

#include <array>
#include <utility>

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

std::string Option::expectation() const {
  switch (type) {
    case OptionType::kFlag:
      return "true or false";
    case OptionType::kInteger:
    case OptionType::kNumber:
      return (may_be_auto ? "auto or " : "") + number_expectation(*this);
    case OptionType::kChoice:
      return "one of " + joined(choices);
    case OptionType::kText:
      return "a text of one line";
  }
  return "";
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
