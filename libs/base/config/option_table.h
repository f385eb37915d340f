// SPDX-License-Identifier: BSD-3-Clause
// All options of a program. Each is described once and bound to a member of the program's settings structs:
//
//     void describe(OptionTable& table, FrontEndOptions& options) {
//       table.section("front_end", "Matching each scan with the active local map")
//           .number("window_m", options.window_m, above(0).at_most(20), "m", "half-width of the window")
//           .angle_deg("window_deg", options.window_rad, above(0).at_most(180), "half-width of headings")
//           .choice("matcher", options.matcher, {{"csm", Matcher::kCsm}, {"ga", Matcher::kGa}}, "search");
//     }
//
// Constants of the method are named, too. Programs of research change them; files and command lines do not.
#pragma once

#include <charconv>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace psi_slam {

struct RangeEnd {
  double value = 0;
  bool inclusive = true;
};

/// Whether the name of an option ends in "_deg".
bool names_degrees(std::string_view name);

/// The numbers that an option accepts: at_least(0), above(0).at_most(20), at_least(0).below(360),
/// any_number(). No range contains NaN or an infinity.
struct NumberRange {
  std::optional<RangeEnd> min;
  std::optional<RangeEnd> max;

  NumberRange at_most(double value) const { return {min, RangeEnd{value, true}}; }
  NumberRange below(double value) const { return {min, RangeEnd{value, false}}; }

  bool contains(double value) const;

  /// Text of the range: "between 0.01 and 20", "0 or more", "above 0 and at most 20", …; "" for any_number().
  std::string words() const;
};

inline NumberRange any_number() {
  return {};
}
inline NumberRange at_least(double value) {
  return {RangeEnd{value, true}, {}};
}
inline NumberRange above(double value) {
  return {RangeEnd{value, false}, {}};
}
inline NumberRange between(double min, double max) {
  return at_least(min).at_most(max);
}

enum class OptionType { kFlag, kInteger, kNumber, kChoice, kText };

/// One option, bound to a member of a settings struct. All code that shows, loads or saves the option uses
/// this description.
struct Option {
  std::string key;  ///< ends in the unit if the option has one: "window_x_m", "window_theta_deg"
  OptionType type = OptionType::kText;
  std::string help{};        ///< description in one line
  std::string unit{};        ///< unit of an integer or number: "m", "deg", "scans"; "" for pure numbers
  NumberRange range{};       ///< accepted values of an integer or number, in `unit`
  bool may_be_auto = false;  ///< whether the text "auto" stands for an empty std::optional
  std::vector<std::string> choices{};  ///< accepted texts of an option of type kChoice
  std::string section{};
  std::string default_text{};  ///< the member's value when the option was described

  /// Returns the member's value as text. Assigning this text restores the value bit for bit.
  std::function<std::string()> text{};
  /// Returns whether the text is a value of this option's type and range.
  std::function<bool(std::string_view text)> accepts{};
  /// Sets the member to the value of the text. Returns false, and changes nothing, if the text is not
  /// accepted.
  std::function<bool(std::string_view text)> assign{};

  std::string name() const { return section + '.' + key; }

  /// The accepted values in words, for a message after "expected": "a number of metres between 0.01 and 20".
  std::string expectation() const;

  /// The accepted values in short form, for listings: "m, between 0.01 and 20", "true or false", "one of csm,
  /// ga".
  std::string values() const;
};

struct OptionSection {
  std::string name;
  std::string title;  ///< heading in one line
  std::vector<Option> options;
};

/// All options of a program, by section. Functions that describe an option take its member by reference. The
/// settings must outlive the table and have their default values when they are described. These functions
/// throw std::logic_error that names the option for a contradictory description. Contradictions are a default
/// outside its range, a key described twice, an angle without the suffix "_deg", and any other option with
/// this suffix.
class OptionTable {
 public:
  /// Begins a section; the options described next belong to it.
  OptionTable& section(std::string name, std::string title);

  OptionTable& flag(std::string key, bool& member, std::string help);

  /// Describes a whole number. `Integer` is any integer type except bool.
  template <class Integer>
  OptionTable& integer(std::string key, Integer& member, NumberRange range, std::string unit,
                       std::string help);

  OptionTable& number(std::string key, double& member, NumberRange range, std::string unit, std::string help);

  /// Describes an angle. The member is in radians; the text and the range are in degrees.
  OptionTable& angle_deg(std::string key, double& member_rad, NumberRange range_deg, std::string help);

  /// Describes a number that the program can choose itself: the text "auto" makes the member empty.
  OptionTable& optional_number(std::string key, std::optional<double>& member, NumberRange range,
                               std::string unit, std::string help);
  OptionTable& optional_angle_deg(std::string key, std::optional<double>& member_rad, NumberRange range_deg,
                                  std::string help);

  template <class Enum>
  OptionTable& choice(std::string key, Enum& member, std::vector<std::pair<std::string, Enum>> choices,
                      std::string help);

  /// Describes an option that accepts any text of one line.
  OptionTable& text(std::string key, std::string& member, std::string help);

  /// Names a constant of the method, "section.key". Only set_any() changes it. `Number` is double, an integer
  /// type or bool. The member of a name that ends in "_deg" is in radians; its text and `range` are in
  /// degrees.
  template <class Number>
  OptionTable& constant(std::string_view name, Number& member, NumberRange range = at_least(0));

  /// Returns whether constant() has the name.
  bool is_constant(std::string_view name) const { return constants_.count(current_name(name)) > 0; }

  /// Gives all constants the values that they have in `other`, a table of the same constants.
  void copy_constants(const OptionTable& other);

  /// Gives all constants their default values.
  void reset_constants();

  /// The constants, by name. Their `key` is the name without its section.
  const std::map<std::string, Option, std::less<>>& constants() const { return constants_; }

  /// Returns the options in their order, then the constants. Valid as long as the table is not changed.
  std::vector<const Option*> options_and_constants() const;

  /// Makes the table accept an old name of an option ("old_section.old_key", "section.key") or of a whole
  /// section ("old_section", "section"). Throws std::logic_error if the new name is not described yet, or if
  /// the old name is in use.
  OptionTable& alias(std::string old_name, std::string new_name);

  /// Makes the table accept an option, "section.key", that exists no more. Its values have no effect, and
  /// set() adds a warning, with the advice `instead` if there is one. Throws std::logic_error if the name is
  /// in use.
  OptionTable& obsolete(std::string name, std::string instead = {});

  /// Returns whether the values of an option in files have no effect: it is obsolete or a constant.
  bool is_ignored(std::string_view name) const { return is_obsolete(name) || is_constant(name); }

  /// Returns whether obsolete() has the option.
  bool is_obsolete(std::string_view name) const { return obsolete_.count(name) > 0; }

  const std::vector<OptionSection>& sections() const { return sections_; }

  /// Current name of the option that is or was called `name`. Returns an unknown name unchanged.
  std::string current_name(std::string_view name) const;

  /// Returns whether an option is or was called `name`, "section.key".
  bool knows(std::string_view name) const;

  /// The option that is or was called `name`, "section.key". Throws UserError that begins with `where`
  /// ("my.ini:12", "--set") and proposes the nearest name if the option is unknown.
  const Option& option(std::string_view name, std::string_view where) const;

  /// Returns the option or the constant that is called `name`, "section.key". Throws UserError as option()
  /// does.
  const Option& option_or_constant(std::string_view name, std::string_view where) const;

  /// Throws UserError that begins with `where` unless a section is or was called `name`, or a constant is in
  /// it.
  void require_section(std::string_view name, std::string_view where) const;

  /// Throws UserError that begins with `where` if the option is unknown or does not accept the text. Obsolete
  /// options and constants accept any text.
  void check(std::string_view name, std::string_view text, std::string_view where) const;

  /// Sets an option to the value of the text. Adds a warning if `name` is an old name. A constant keeps its
  /// value, and another value leaves a warning. Throws UserError as check() does, and then changes nothing.
  void set(std::string_view name, std::string_view text, std::string_view where);

  /// Sets a constant to the value of the text, and an option as set() does. For programs of research. Throws
  /// UserError that begins with `where` if the text is no value of the constant.
  void set_any(std::string_view name, std::string_view text, std::string_view where);

  /// Returns the warnings since the last call and clears them. Each file gets one warning, a sentence without
  /// full stop, for each old name that set() received from it: "my.ini:12: section [last_pass] was renamed;
  /// write [final_search]". All obsolete options and constants of a file share one warning.
  std::vector<std::string> take_warnings();

 private:
  OptionTable& add(Option option);
  OptionTable& add_constant(std::string_view name, Option option);

  void warn_of_old_name(std::string_view old_name, const std::string& new_name, std::string_view where);

  std::vector<OptionSection> sections_;
  /// Maps old names to new names; names of sections have no dot.
  std::map<std::string, std::string, std::less<>> aliases_;
  std::map<std::string, std::string, std::less<>> obsolete_;  ///< names, with the advice for a warning
  std::map<std::string, Option, std::less<>> constants_;
  struct ObsoleteOptions {
    std::string where;  ///< place of the first one
    std::vector<std::string> names;
  };
  std::map<std::string, ObsoleteOptions> obsolete_of_;  ///< those that set() received, by file
  std::vector<std::string> warnings_;
  std::set<std::string> warned_;  ///< warnings without line numbers, to warn once per file
};

/// Returns the option, bound to `member`. `parse` returns an optional value of a text, `format` the text of a
/// value.
template <class T, class Parse, class Format>
Option bound_option(Option option, T& member, Parse parse, Format format) {
  option.text = [&member, format] { return format(member); };
  option.accepts = [parse](std::string_view text) { return std::optional<T>(parse(text)).has_value(); };
  option.assign = [&member, parse](std::string_view text) {
    std::optional<T> value = parse(text);
    if (!value) return false;
    member = *std::move(value);
    return true;
  };
  return option;
}

Option bound_number(Option option, double& member, bool is_angle);
Option bound_flag(Option option, bool& member);

template <class Integer>
Option bound_integer(Option option, Integer& member) {
  static_assert(std::is_integral_v<Integer> && !std::is_same_v<Integer, bool>);
  NumberRange& range = option.range;
  if (std::is_unsigned_v<Integer> && !range.min) range.min = RangeEnd{0, true};
  const auto parse = [range](std::string_view text) -> std::optional<Integer> {
    Integer value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc{} || end != text.data() + text.size()) return {};
    if (!range.contains(static_cast<double>(value))) return {};
    return value;
  };
  return bound_option(std::move(option), member, parse, [](Integer value) { return std::to_string(value); });
}

template <class Integer>
OptionTable& OptionTable::integer(std::string key, Integer& member, NumberRange range, std::string unit,
                                  std::string help) {
  return add(
      bound_integer({std::move(key), OptionType::kInteger, std::move(help), std::move(unit), range}, member));
}

template <class Number>
OptionTable& OptionTable::constant(std::string_view name, Number& member, NumberRange range) {
  Option option{std::string(name.substr(name.find('.') + 1))};
  option.range = range;
  if constexpr (std::is_same_v<Number, bool>) {
    option.type = OptionType::kFlag;
    return add_constant(name, bound_flag(std::move(option), member));
  } else if constexpr (std::is_integral_v<Number>) {
    option.type = OptionType::kInteger;
    return add_constant(name, bound_integer(std::move(option), member));
  } else {
    option.type = OptionType::kNumber;
    const bool is_angle = names_degrees(name);
    option.unit = is_angle ? "deg" : "";
    return add_constant(name, bound_number(std::move(option), member, is_angle));
  }
}

template <class Enum>
OptionTable& OptionTable::choice(std::string key, Enum& member,
                                 std::vector<std::pair<std::string, Enum>> choices, std::string help) {
  Option option{std::move(key), OptionType::kChoice, std::move(help)};
  for (const auto& [name, value] : choices) option.choices.push_back(name);
  const auto parse = [choices](std::string_view text) -> std::optional<Enum> {
    for (const auto& [name, value] : choices)
      if (name == text) return value;
    return {};
  };
  const auto format = [choices](Enum member_value) -> std::string {
    for (const auto& [name, value] : choices)
      if (value == member_value) return name;
    return "(a value without name)";
  };
  return add(bound_option(std::move(option), member, parse, format));
}

}  // namespace psi_slam
