// SPDX-License-Identifier: BSD-3-Clause
#include "config/option_table.h"

#include <algorithm>
#include <array>
#include <stdexcept>

#include "base/number_text.h"
#include "config/nearest_name.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::string_view kAuto = "auto";

std::string quoted(std::string_view text) {
  return '"' + std::string(text) + '"';
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

/// Reads a number and converts it to the unit of the member; empty if it is out of range.
std::optional<double> parse_in_range(std::string_view text, const NumberRange& range, bool is_angle) {
  const std::optional<double> value = parse_number(text);
  if (!value || !range.contains(*value)) return {};
  return is_angle ? parse_degrees(text) : value;
}

std::string number_text(double value, bool is_angle) {
  return is_angle ? exact_degrees_text(value) : exact_text(value);
}

Option describe(std::string key, OptionType type, std::string help) {
  Option option;
  option.key = std::move(key);
  option.type = type;
  option.help = std::move(help);
  return option;
}

Option describe_number(std::string key, const NumberRange& range, std::string unit, std::string help) {
  Option option = describe(std::move(key), OptionType::kNumber, std::move(help));
  option.range = range;
  option.unit = std::move(unit);
  return option;
}

bool is_angle(const Option& option) {
  return option.type == OptionType::kNumber && option.unit == "deg";
}

void refuse_degrees(const std::string& key, const std::string& unit) {
  if (unit == "deg") throw std::logic_error(key + ": angles are described by angle_deg");
}

bool names_degrees(std::string_view key) {
  constexpr std::string_view kSuffix = "_deg";
  return key.size() > kSuffix.size() && key.substr(key.size() - kSuffix.size()) == kSuffix;
}

std::vector<std::string> names(const std::vector<OptionSection>& sections) {
  std::vector<std::string> result;
  result.reserve(sections.size());
  for (const OptionSection& section : sections) result.push_back(section.name);
  return result;
}

std::vector<std::string> keys(const OptionSection& section) {
  std::vector<std::string> result;
  result.reserve(section.options.size());
  for (const Option& option : section.options) result.push_back(option.key);
  return result;
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

/// Section and key of "section.key"; no key if there is no dot.
std::pair<std::string_view, std::string_view> parts(std::string_view name) {
  const std::size_t dot = name.find('.');
  if (dot == std::string_view::npos) return {name, {}};
  return {name.substr(0, dot), name.substr(dot + 1)};
}

/// Proposal for an unknown key, as the end of a sentence; can be empty.
std::string proposal(const std::vector<OptionSection>& sections, const OptionSection& here,
                     std::string_view key) {
  for (const OptionSection& section : sections)
    if (find(section, key) != nullptr) return "; " + quoted(key) + " belongs in [" + section.name + ']';
  if (const auto near = nearest_name(key, keys(here))) return "; did you mean " + quoted(*near) + '?';
  for (const OptionSection& section : sections) {
    if (const auto near = nearest_name(key, keys(section)))
      return "; did you mean " + quoted(*near) + " in [" + section.name + "]?";
  }
  return "";
}

}  // namespace

OptionTable& OptionTable::section(std::string name, std::string title) {
  if (find(sections_, name) != nullptr) throw std::logic_error("section [" + name + "] is described twice");
  sections_.push_back({std::move(name), std::move(title), {}});
  return *this;
}

OptionTable& OptionTable::add_bound(Option option) {
  if (sections_.empty()) throw std::logic_error(option.key + " is described outside any section");
  OptionSection& section = sections_.back();
  option.section = section.name;
  if (find(section, option.key) != nullptr) throw std::logic_error(option.name() + " is described twice");
  if (names_degrees(option.key) != is_angle(option))
    throw std::logic_error(option.name() + ": the key of an angle ends in _deg, and no other key does");
  option.default_text = option.text();
  if (!option.accepts(option.default_text)) {
    throw std::logic_error(option.name() + ": its default " + option.default_text + " is not " +
                           option.expectation());
  }
  section.options.push_back(std::move(option));
  return *this;
}

OptionTable& OptionTable::add_number(Option option, double& member) {
  const auto parse = [range = option.range, angle = is_angle(option)](std::string_view text) {
    return parse_in_range(text, range, angle);
  };
  const auto format = [angle = is_angle(option)](double value) { return number_text(value, angle); };
  return add(std::move(option), member, parse, format);
}

OptionTable& OptionTable::add_optional_number(Option option, std::optional<double>& member) {
  using Value = std::optional<double>;
  option.may_be_auto = true;
  const auto parse = [range = option.range,
                      angle = is_angle(option)](std::string_view text) -> std::optional<Value> {
    if (text == kAuto) return std::optional<Value>(std::in_place);
    const Value value = parse_in_range(text, range, angle);
    return value ? std::optional<Value>(value) : std::nullopt;
  };
  const auto format = [angle = is_angle(option)](const Value& value) {
    return value ? number_text(*value, angle) : std::string(kAuto);
  };
  return add(std::move(option), member, parse, format);
}

OptionTable& OptionTable::flag(std::string key, bool& member, std::string help) {
  return add(describe(std::move(key), OptionType::kFlag, std::move(help)), member, parse_flag,
             [](bool value) -> std::string { return value ? "true" : "false"; });
}

OptionTable& OptionTable::number(std::string key, double& member, NumberRange range, std::string unit,
                                 std::string help) {
  refuse_degrees(key, unit);
  return add_number(describe_number(std::move(key), range, std::move(unit), std::move(help)), member);
}

OptionTable& OptionTable::angle_deg(std::string key, double& member_rad, NumberRange range_deg,
                                    std::string help) {
  return add_number(describe_number(std::move(key), range_deg, "deg", std::move(help)), member_rad);
}

OptionTable& OptionTable::optional_number(std::string key, std::optional<double>& member, NumberRange range,
                                          std::string unit, std::string help) {
  refuse_degrees(key, unit);
  return add_optional_number(describe_number(std::move(key), range, std::move(unit), std::move(help)),
                             member);
}

OptionTable& OptionTable::optional_angle_deg(std::string key, std::optional<double>& member_rad,
                                             NumberRange range_deg, std::string help) {
  return add_optional_number(describe_number(std::move(key), range_deg, "deg", std::move(help)), member_rad);
}

OptionTable& OptionTable::text(std::string key, std::string& member, std::string help) {
  return add(describe(std::move(key), OptionType::kText, std::move(help)), member, parse_line,
             [](const std::string& value) { return value; });
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
  std::string sentence = std::string(where) + ": unknown section [" + std::string(name) + "]; ";
  if (const auto near = nearest_name(name, names(sections_))) {
    sentence += "did you mean [" + *near + "]?";
  } else {
    sentence += "the sections are";
    for (const OptionSection& section : sections_) sentence += " [" + section.name + ']';
  }
  throw UserError(sentence);
}

const Option& OptionTable::option(std::string_view name, std::string_view where) const {
  if (name.find('.') == std::string_view::npos)
    throw UserError(std::string(where) + ": expected section.key, not " + quoted(name));
  const std::string current = current_name(name);
  const auto [section_name, key] = parts(current);
  require_section(section_name, where);
  const OptionSection& section = *find(sections_, section_name);
  if (const Option* option = find(section, key)) return *option;
  throw UserError(std::string(where) + ": unknown key " + quoted(key) + " in [" + section.name + ']' +
                  proposal(sections_, section, key));
}

void OptionTable::check(std::string_view name, std::string_view text, std::string_view where) const {
  const Option& target = option(name, where);
  if (target.accepts(text)) return;
  throw UserError(std::string(where) + ": " + target.name() + " = " + std::string(text) + ": expected " +
                  target.expectation());
}

void OptionTable::set(std::string_view name, std::string_view text, std::string_view where) {
  check(name, text, where);
  const Option& target = option(name, where);
  target.assign(text);
  if (target.name() != name) warn_of_old_name(name, target.name(), where);
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
  if (warned_.insert(std::string(where.substr(0, where.rfind(':'))) + sentence).second)
    warnings_.push_back(std::string(where) + sentence);
}

std::vector<std::string> OptionTable::take_warnings() {
  warned_.clear();
  return std::exchange(warnings_, {});
}

}  // namespace psi_slam
