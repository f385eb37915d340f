// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <ostream>
#include <string_view>

#include "base/config/settings_text.h"
#include "base/exit_code.h"
#include "commands.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// The options that most users change, if they change any.
constexpr std::array<std::string_view, 10> kCommon = {
    "log.laser",        "log.laser_mounts", "log.max_range_m", "log.min_range_m",      "log.calibrate",
    "map.resolution_m", "map.keep_moving",  "map.align",       "loop_closure.enabled", "run.threads",
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
  return text;
}

bool is_common(const Option& option) {
  return std::find(kCommon.begin(), kCommon.end(), option.name()) != kCommon.end();
}

const char* type_name(OptionType type) {
  switch (type) {
    case OptionType::kFlag:
      return "flag";
    case OptionType::kInteger:
      return "integer";
    case OptionType::kNumber:
      return "number";
    case OptionType::kChoice:
      return "choice";
    case OptionType::kText:
      break;
  }
  return "text";
}

nlohmann::ordered_json json_of(const Option& option) {
  nlohmann::ordered_json json{
      {"name", option.name()},          {"section", option.section},      {"key", option.key},
      {"type", type_name(option.type)}, {"default", option.default_text}, {"help", option.help}};
  if (!option.unit.empty()) json["unit"] = option.unit;
  if (option.may_be_auto) json["may_be_auto"] = true;
  if (!option.choices.empty()) json["choices"] = option.choices;
  if (const auto& min = option.range.min) json[min->inclusive ? "min" : "above"] = min->value;
  if (const auto& max = option.range.max) json[max->inclusive ? "max" : "below"] = max->value;
  return json;
}

}  // namespace

int explain_options(const CommandLine& line, const Streams& streams) {
  const std::string word = lower(line.options.word);
  const auto selects = [&](const Option& option) {
    if (line.options.common && !is_common(option)) return false;
    return lower(option.name() + '\n' + option.help).find(word) != std::string::npos;
  };
  const auto table = default_settings();
  nlohmann::ordered_json all = nlohmann::ordered_json::array();
  for (const OptionSection& section : table->sections())
    for (const Option& option : section.options)
      if (selects(option)) all.push_back(json_of(option));
  if (all.empty() && line.options.common)
    throw UserError("none of the ten common options has \"" + line.options.word +
                    "\" in its name or description. Leave --common out");
  if (all.empty())
    throw UserError("no option has \"" + line.options.word +
                    "\" in its name or description. psi-slam options lists all");
  if (line.options.markdown)
    streams.out << markdown_reference(*table);
  else if (line.json)
    streams.out << all.dump(2) << '\n';
  else
    streams.out << help_text(*table, selects);
  return kExitDone;
}

}  // namespace psi_slam
