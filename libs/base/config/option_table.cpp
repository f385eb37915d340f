// SPDX-License-Identifier: BSD-3-Clause
#include "base/config/option_table.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "base/config/nearest_name.h"
#include "base/number_text.h"
#include "base/quotable_text.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::string_view kAuto = "auto";
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> kUnitWords{
    {{"m", "metres"}, {"deg", "degrees"}, {"s", "seconds"}, {"ms", "milliseconds"}}};

std::string of_unit(const std::string& unit) {
  if (unit.empty()) return "";
  for (const auto& [symbol, word] : kUnitWords)
    if (symbol == unit) return " of " + std::string(word);
  const bool is_word = unit.find_first_of("/^ ") == std::string::npos && unit.size() > 3;
  return (is_word ? " of " : " in ") + unit;
}

std::string number_expectation(const Option& option) {
  std::string text = option.type == OptionType::kInteger ? "a whole number" : "a number";
  text += of_unit(option.unit);
  const std::string range = option.range.words();
  const bool range_is_aside = range.find(" or ") != std::string::npos;
  return range.empty() ? text : text + (range_is_aside ? ", " : " ") + range;
}

std::string in_quotes(std::string_view text) {
  return '"' + quotable(text) + '"';
}

std::optional<bool> parse_flag(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  for (const char* yes : {"true", "yes", "on", "1"})
    if (lower == yes) return true;
  for (const char* no : {"false", "no", "off", "0"})
    if (lower == no) return false;
  return {};
}

std::optional<std::string> parse_line(std::string_view text) {
  constexpr unsigned char kDelete = 0x7f;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if ((byte < ' ' && c != '\t') || byte == kDelete) return {};
  }
  return std::string(text);
}

template <class Items>
std::vector<std::string> names_of(const Items& items, std::string Items::value_type::*name) {
  std::vector<std::string> names;
  for (const auto& item : items) names.push_back(item.*name);
  return names;
}

const OptionSection* find(const std::vector<OptionSection>& sections, std::string_view name) {
  const auto found = std::find_if(sections.begin(), sections.end(),
                                  [&](const auto& section) { return section.name == name; });
  return found == sections.end() ? nullptr : &*found;
}

const Option* find(const OptionSection& section, std::string_view key) {
  const auto found = std::find_if(section.options.begin(), section.options.end(),
                                  [&](const auto& option) { return option.key == key; });
  return found == section.options.end() ? nullptr : &*found;
}

/// Section and key of "section.key". The key is empty if there is no dot.
std::pair<std::string_view, std::string_view> parts(std::string_view name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return {name, {}};
  return {name.substr(0, dot), name.substr(dot + 1)};
}

/// Proposal for an unknown key, as the end of a sentence. Empty if no key is similar.
std::string proposal(const std::vector<OptionSection>& sections, const OptionSection& here,
                     std::string_view key) {
  for (const OptionSection& section : sections)
    if (find(section, key) != nullptr) return "; " + in_quotes(key) + " belongs in [" + section.name + ']';
  if (const auto near = nearest_name(key, names_of(here.options, &Option::key)))
    return "; did you mean " + in_quotes(*near) + '?';
  for (const OptionSection& section : sections) {
    if (const auto near = nearest_name(key, names_of(section.options, &Option::key)))
      return "; did you mean " + in_quotes(*near) + " in [" + section.name + "]?";
  }
  return "";
}

/// Whether the text is another way to write the current value of the option.
bool has_value(const Option& option, std::string_view text) {
  const std::string now = option.text();
  if (!option.assign(text)) return false;
  const bool is_equal = option.text() == now;
  option.assign(now);
  return is_equal;
}

// Returns the file of a place such as "my.ini:12".
std::string file_of(std::string_view where) {
  return std::string(where.substr(0, where.rfind(':')));
}

/// Binds a number or an angle. `Number` is double, or std::optional<double> for an option that can be "auto".
template <class Number>
Option number_or_angle(Option option, Number& member, bool is_angle) {
  if (!is_angle && option.unit == "deg")
    throw std::logic_error(option.key + ": angles are described by angle_deg");
  option.may_be_auto = std::is_same_v<Number, std::optional<double>>;
  const auto parse = [may_be_auto = option.may_be_auto, range = option.range,
                      is_angle](std::string_view text) -> std::optional<Number> {
    if (may_be_auto && text == kAuto) return Number();
    const std::optional<double> value = parse_number(text);
    if (!value || !range.contains(*value)) return {};
    return Number(*(is_angle ? parse_degrees(text) : value));
  };
  const auto format = [is_angle](const std::optional<double>& value) {
    if (!value) return std::string(kAuto);
    return is_angle ? exact_degrees_text(*value) : exact_text(*value);
  };
  return bound_option(std::move(option), member, parse, format);
}

}  // namespace

bool names_degrees(std::string_view name) {
  constexpr std::string_view kSuffix = "_deg";
  return name.size() > kSuffix.size() && name.substr(name.size() - kSuffix.size()) == kSuffix;
}

Option bound_number(Option option, double& member, bool is_angle) {
  return number_or_angle(std::move(option), member, is_angle);
}

Option bound_flag(Option option, bool& member) {
  return bound_option(std::move(option), member, parse_flag,
                      [](bool value) -> std::string { return value ? "true" : "false"; });
}

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
    case OptionType::kNumber: {
      const std::string number = type == OptionType::kInteger ? "whole number" : "number";
      const std::string words = range.words();
      return (unit.empty() ? number : unit) + (words.empty() ? "" : ", ") + words +
             (may_be_auto ? "; or auto" : "");
    }
    case OptionType::kChoice:
      return "one of " + name_list(choices);
    case OptionType::kText:
      return "text";
  }
  return "";
}

OptionTable& OptionTable::section(std::string name, std::string title) {
  if (find(sections_, name) != nullptr) throw std::logic_error("section [" + name + "] is described twice");
  sections_.push_back({std::move(name), std::move(title), {}});
  return *this;
}

OptionTable& OptionTable::add(Option option) {
  if (sections_.empty()) throw std::logic_error(option.key + " is described outside any section");
  OptionSection& section = sections_.back();
  option.section = section.name;
  if (find(section, option.key) != nullptr) throw std::logic_error(option.name() + " is described twice");
  const bool is_angle = option.type == OptionType::kNumber && option.unit == "deg";
  if (names_degrees(option.key) != is_angle)
    throw std::logic_error(option.name() + ": the key of an angle ends in _deg, and no other key does");
  option.default_text = option.text();
  if (!option.accepts(option.default_text)) {
    throw std::logic_error(option.name() + ": its default " + option.default_text + " is not " +
                           option.expectation());
  }
  section.options.push_back(std::move(option));
  return *this;
}

OptionTable& OptionTable::add_constant(std::string_view name, Option option) {
  option.section = name.substr(0, name.find('.'));
  option.default_text = option.text();
  if (!option.accepts(option.default_text))
    throw std::logic_error("the default of the constant " + std::string(name) + " is not in its range");
  if (knows(name) || is_ignored(name)) throw std::logic_error("constant " + std::string(name) + " is in use");
  constants_.emplace(name, std::move(option));
  return *this;
}

OptionTable& OptionTable::flag(std::string key, bool& member, std::string help) {
  return add(bound_flag({std::move(key), OptionType::kFlag, std::move(help)}, member));
}

OptionTable& OptionTable::number(std::string key, double& member, NumberRange range, std::string unit,
                                 std::string help) {
  return add(number_or_angle({std::move(key), OptionType::kNumber, std::move(help), std::move(unit), range},
                             member, false));
}

OptionTable& OptionTable::angle_deg(std::string key, double& member_rad, NumberRange range_deg,
                                    std::string help) {
  return add(number_or_angle({std::move(key), OptionType::kNumber, std::move(help), "deg", range_deg},
                             member_rad, true));
}

OptionTable& OptionTable::optional_number(std::string key, std::optional<double>& member, NumberRange range,
                                          std::string unit, std::string help) {
  return add(number_or_angle({std::move(key), OptionType::kNumber, std::move(help), std::move(unit), range},
                             member, false));
}

OptionTable& OptionTable::optional_angle_deg(std::string key, std::optional<double>& member_rad,
                                             NumberRange range_deg, std::string help) {
  return add(number_or_angle({std::move(key), OptionType::kNumber, std::move(help), "deg", range_deg},
                             member_rad, true));
}

OptionTable& OptionTable::text(std::string key, std::string& member, std::string help) {
  return add(bound_option({std::move(key), OptionType::kText, std::move(help)}, member, parse_line,
                          [](const std::string& value) { return value; }));
}

OptionTable& OptionTable::alias(std::string old_name, std::string new_name) {
  const bool is_option = new_name.find('.') != std::string::npos;
  if (is_option != (old_name.find('.') != std::string::npos))
    throw std::logic_error(old_name + " and " + new_name + " must both be options or both be sections");
  if (is_option ? !knows(new_name) : find(sections_, new_name) == nullptr)
    throw std::logic_error(old_name + " cannot stand for " + new_name + ", which is not described yet");
  if (is_option ? knows(old_name) : find(sections_, old_name) != nullptr || aliases_.count(old_name) > 0)
    throw std::logic_error("old name " + old_name + " is in use");
  aliases_.emplace(std::move(old_name), std::move(new_name));
  return *this;
}

OptionTable& OptionTable::obsolete(std::string name, std::string instead) {
  if (knows(name) || is_constant(name)) throw std::logic_error("obsolete option " + name + " is in use");
  obsolete_.emplace(std::move(name), std::move(instead));
  return *this;
}

std::string OptionTable::current_name(std::string_view name) const {
  if (const auto renamed = aliases_.find(name); renamed != aliases_.end()) return renamed->second;
  const auto [section, key] = parts(name);
  const auto renamed = aliases_.find(section);
  if (renamed == aliases_.end()) return std::string(name);
  const std::string moved = renamed->second + '.' + std::string(key);
  const auto renamed_key = aliases_.find(moved);
  return renamed_key == aliases_.end() ? moved : renamed_key->second;
}

bool OptionTable::knows(std::string_view name) const {
  const std::string current = current_name(name);
  const auto [section_name, key] = parts(current);
  const OptionSection* const section = find(sections_, section_name);
  return section != nullptr && find(*section, key) != nullptr;
}

void OptionTable::require_section(std::string_view name, std::string_view where) const {
  if (find(sections_, name) != nullptr || aliases_.count(name) > 0) return;
  for (const auto& [full_name, constant] : constants_)
    if (constant.section == name) return;
  std::string sentence = std::string(where) + ": unknown section [" + quotable(name) + "]; ";
  if (const auto near = nearest_name(name, names_of(sections_, &OptionSection::name))) {
    sentence += "did you mean [" + *near + "]?";
  } else {
    sentence += "the sections are";
    for (const OptionSection& section : sections_) sentence += " [" + section.name + ']';
  }
  throw UserError(sentence);
}

const Option& OptionTable::option(std::string_view name, std::string_view where) const {
  if (name.find('.') == std::string_view::npos)
    throw UserError(std::string(where) + ": expected section.key, not " + in_quotes(name));
  const std::string current = current_name(name);
  const auto [section_name, key] = parts(current);
  require_section(section_name, where);
  const OptionSection constants_alone{std::string(section_name), {}, {}};
  const OptionSection* const found = find(sections_, section_name);
  const OptionSection& section = found == nullptr ? constants_alone : *found;
  if (const Option* option = find(section, key)) return *option;
  throw UserError(std::string(where) + ": unknown key " + in_quotes(key) + " in [" + section.name + ']' +
                  proposal(sections_, section, key));
}

const Option& OptionTable::option_or_constant(std::string_view name, std::string_view where) const {
  const auto constant = constants_.find(current_name(name));
  return constant == constants_.end() ? option(name, where) : constant->second;
}

void OptionTable::check(std::string_view name, std::string_view text, std::string_view where) const {
  if (is_ignored(name)) return;
  const Option& target = option(name, where);
  if (target.accepts(text)) return;
  throw UserError(std::string(where) + ": " + target.name() + " = " + quotable(text) + ": expected " +
                  target.expectation());
}

void OptionTable::set(std::string_view name, std::string_view text, std::string_view where) {
  check(name, text, where);
  if (is_ignored(name)) {
    std::string remark;
    if (const auto constant = constants_.find(current_name(name)); constant != constants_.end()) {
      if (has_value(constant->second, text)) return;
      remark = "always " + constant->second.text();
    } else {
      remark = obsolete_.find(name)->second;
    }
    ObsoleteOptions& found = obsolete_of_[file_of(where)];
    if (found.names.empty()) found.where = where;
    found.names.push_back(std::string(name) + (remark.empty() ? "" : " (" + remark + ')'));
    return;
  }
  const Option& target = option(name, where);
  target.assign(text);
  if (target.name() != name) warn_of_old_name(name, target.name(), where);
}

void OptionTable::set_any(std::string_view name, std::string_view text, std::string_view where) {
  const auto constant = constants_.find(current_name(name));
  if (constant == constants_.end()) return set(name, text, where);
  if (!constant->second.assign(text))
    throw UserError(std::string(where) + ": " + std::string(name) + " = " + quotable(text) + ": expected " +
                    constant->second.expectation());
}

std::vector<const Option*> OptionTable::options_and_constants() const {
  std::vector<const Option*> all;
  for (const OptionSection& section : sections_)
    for (const Option& option : section.options) all.push_back(&option);
  for (const auto& [name, constant] : constants_) all.push_back(&constant);
  return all;
}

void OptionTable::copy_constants(const OptionTable& other) {
  for (auto& [name, constant] : constants_) constant.assign(other.constants_.at(name).text());
}

void OptionTable::reset_constants() {
  for (auto& [name, constant] : constants_) constant.assign(constant.default_text);
}

void OptionTable::warn_of_old_name(std::string_view old_name, const std::string& new_name,
                                   std::string_view where) {
  const auto [old_section, old_key] = parts(old_name);
  const auto [new_section, new_key] = parts(new_name);
  const bool only_section = old_key == new_key && aliases_.count(old_name) == 0;
  std::string sentence = ": ";
  if (only_section)
    sentence.append("section [").append(old_section).append("] was renamed; write [").append(new_section) +=
        ']';
  else
    sentence.append("option ").append(old_name).append(" was renamed; write ").append(new_name);
  if (warned_.insert(file_of(where) + sentence).second) warnings_.push_back(std::string(where) + sentence);
}

std::vector<std::string> OptionTable::take_warnings() {
  warned_.clear();
  for (auto& [file, found] : std::exchange(obsolete_of_, {})) {
    std::sort(found.names.begin(), found.names.end());
    found.names.erase(std::unique(found.names.begin(), found.names.end()), found.names.end());
    std::string names;
    for (const std::string& name : found.names) names += (names.empty() ? "" : ", ") + name;
    warnings_.push_back(found.where + ": " + names +
                        (found.names.size() == 1 ? " has no effect any more; remove it"
                                                 : " have no effect any more; remove them"));
  }
  return std::exchange(warnings_, {});
}

}  // namespace psi_slam
