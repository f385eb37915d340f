// SPDX-License-Identifier: BSD-3-Clause
#include "logs/frames/laser_choice.h"

#include <mrpt/core/bits_math.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "base/number_text.h"
#include "base/text_parts.h"
#include "logs/frames/height_slice.h"
#include "logs/frames/laser_readings.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr const char* kMirrored = "mirrored";

std::vector<std::string> split(std::string_view text, std::string_view separators) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t end = text.find_first_of(separators);
    words.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end + 1);
  }
}

std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words = split(text, " \t");
  words.erase(std::remove(words.begin(), words.end(), ""), words.end());
  return words;
}

/// Joins the words of a name, which may contain spaces.
std::string joined(std::vector<std::string>::const_iterator begin,
                   std::vector<std::string>::const_iterator end) {
  std::string name;
  for (auto word = begin; word != end; ++word) name += (name.empty() ? "" : " ") + *word;
  return name;
}

/// Parses NAME X Y YAW [mirrored].
std::optional<StatedMount> mount_from(const std::string& text) {
  std::vector<std::string> words = words_of(text);
  StatedMount mount;
  if (!words.empty() && words.back() == kMirrored) {
    mount.mirrored = true;
    words.pop_back();
  }
  if (words.size() < 4) return std::nullopt;
  const auto numbers = words.end() - 3;
  const auto x_m = parse_number(numbers[0]);
  const auto y_m = parse_number(numbers[1]);
  const auto yaw_deg = parse_number(numbers[2]);
  if (!x_m || !y_m || !yaw_deg) return std::nullopt;
  mount.robot_T_laser = {*x_m, *y_m, mrpt::DEG2RAD(*yaw_deg)};
  if (!is_possible_mount(mount.robot_T_laser)) return std::nullopt;
  mount.robot_T_laser.normalizePhi();
  mount.name = joined(words.begin(), numbers);
  return mount;
}

/// Parses SECONDS or NAME SECONDS.
std::optional<StatedDelay> delay_from(const std::string& text) {
  const std::vector<std::string> words = words_of(text);
  const auto delay_s = words.empty() ? std::nullopt : parse_number(words.back());
  if (!delay_s || !(std::abs(*delay_s) <= kMostScanDelay_s)) return std::nullopt;
  return StatedDelay{joined(words.begin(), words.end() - 1), *delay_s};
}

template <class Value>
[[noreturn]] void fail(const char* key, Value value, const char* expected) {
  std::ostringstream sentence;
  sentence << key << " is " << value << ", expected " << expected;
  throw UserError(sentence.str());
}

}  // namespace

LaserChoice laser_choice(std::string_view option, std::string_view value) {
  LaserChoice choice;
  choice.all = value == "all";
  if (choice.all || value.empty()) return choice;
  for (const std::string& part : split(value, ",")) {
    const std::string name(trimmed(part));
    const char* fault = name.empty()                   ? "\" with an empty name"
                        : contains(choice.names, name) ? "\" with a repeated name"
                                                       : nullptr;
    if (fault != nullptr)
      throw UserError(std::string(option) + " is \"" + std::string(value) + fault +
                      ", expected one laser, \"all\", or several lasers separated by commas");
    choice.names.push_back(name);
  }
  return choice;
}

bool reads_several_lasers(const LogOptions& options, LogFormat format) {
  const bool by_topic = is_bag(format) && !options.scan_topic.empty();
  const LaserChoice choice = by_topic ? laser_choice("log.scan_topic", options.scan_topic)
                                      : laser_choice("log.laser", options.laser);
  if (choice.several() && options.robot_T_laser)
    throw UserError(
        "log.laser_x_m, log.laser_y_m and log.laser_yaw_deg are for a single laser, but several are "
        "selected. State their mounts with log.laser_mounts, such as \"RLASER -0.3 0 180\" (metres, "
        "degrees)");
  return choice.several();
}

std::optional<std::size_t> ChosenLasers::number_of(const std::string& name) {
  if (const auto known = numbers_.find(name); known != numbers_.end()) return known->second;
  std::size_t number = numbers_.size();
  if (!choice_.names.empty()) {
    const auto listed = std::find(choice_.names.begin(), choice_.names.end(), name);
    if (listed == choice_.names.end()) return std::nullopt;
    number = static_cast<std::size_t>(listed - choice_.names.begin());
  } else if (!choice_.all && number > 0) {
    return std::nullopt;
  }
  numbers_[name] = number;
  return number;
}

std::vector<std::string> ChosenLasers::names() const {
  if (!choice_.names.empty()) return choice_.names;
  std::vector<std::string> names(numbers_.size());
  for (const auto& [name, number] : numbers_) names[number] = name;
  return names;
}

std::string choice_of_lasers(const std::vector<std::string>& combined,
                             const std::vector<std::string>& left_out) {
  std::string text;
  if (combined.size() > 1)
    text = "the scans of " + name_list(combined) + " are combined, because their mounts are stated";
  if (!left_out.empty())
    text += (text.empty() ? "the scans of " : ". The scans of ") + name_list(left_out) +
            " are not used, because no fixed and level mount of their own is stated. State mounts with "
            "log.laser_mounts";
  return text.empty() ? text : text + ". Select lasers with log.laser";
}

std::string late_laser_text(const std::string& option, const std::string& name) {
  return option + " names the laser \"" + name +
         "\", of which no scan came in the first seconds. It is read from its first scan on. Check its name "
         "if it never sends";
}

std::vector<StatedMount> stated_mounts(const LogOptions& options) {
  std::vector<StatedMount> mounts;
  if (trimmed(options.laser_mounts).empty()) return mounts;
  for (const std::string& text : split(options.laser_mounts, ",")) {
    auto mount = mount_from(text);
    if (!mount)
      throw UserError(
          "log.laser_mounts contains \"" + std::string(trimmed(text)) +
          "\", expected a laser's name, x and y of at most 100 m and yaw in degrees, such as \"RLASER "
          "-0.3 0 180\". Separate several mounts by commas");
    mounts.push_back(*std::move(mount));
  }
  return mounts;
}

std::vector<StatedDelay> stated_delays(const LogOptions& options) {
  const std::string_view value = trimmed(options.scan_delay_s);
  std::vector<StatedDelay> delays;
  if (value.empty() || value == "auto") return delays;
  const std::vector<std::string> texts = split(value, ",");
  for (const std::string& text : texts) {
    auto delay = delay_from(text);
    const bool is_known = delay && std::any_of(delays.begin(), delays.end(), [&](const StatedDelay& other) {
                            return other.name == delay->name;
                          });
    if (!delay || is_known || (delay->name.empty() && texts.size() > 1))
      throw UserError("log.scan_delay_s is \"" + options.scan_delay_s +
                      "\", expected auto, -600 to 600 seconds, or a laser's name and its seconds such as "
                      "\"RLASER 0.1\". Separate several lasers by commas, and name each one once");
    delays.push_back(*std::move(delay));
  }
  return delays;
}

double delay_of_laser(const std::vector<StatedDelay>& delays, const std::vector<std::string>& names) {
  for (const StatedDelay& delay : delays)
    if (delay.name.empty() || contains(names, delay.name)) return delay.delay_s;
  return 0;
}

std::string scan_delay_text(const std::vector<StatedDelay>& delays) {
  if (delays.empty()) return "auto";
  std::vector<std::string> texts;
  for (const StatedDelay& delay : delays)
    texts.push_back((delay.name.empty() ? "" : delay.name + " ") + exact_text(delay.delay_s));
  return name_list(texts);
}

std::vector<std::pair<const char*, std::string>> lasers_with_stated_values(const LogOptions& options) {
  std::vector<std::pair<const char*, std::string>> lasers;
  for (const StatedMount& mount : stated_mounts(options)) lasers.emplace_back("log.laser_mounts", mount.name);
  for (const StatedDelay& delay : stated_delays(options))
    if (!delay.name.empty()) lasers.emplace_back("log.scan_delay_s", delay.name);
  return lasers;
}

LogOptions options_of_laser(const LogOptions& options, const std::vector<std::string>& names) {
  LogOptions own = options;
  if (const auto delays = stated_delays(options); !delays.empty())
    own.scan_delay_s = scan_delay_text({{"", delay_of_laser(delays, names)}});
  for (const StatedMount& mount : stated_mounts(options)) {
    if (!contains(names, mount.name)) continue;
    if (!own.robot_T_laser) own.robot_T_laser = mount.robot_T_laser;
    own.mirrored = own.mirrored || mount.mirrored;
  }
  return own;
}

bool can_be_listed(const std::string& name) {
  return !name.empty() && name != "all" && name.find(',') == std::string::npos && trimmed(name) == name;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

std::string quoted_list(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "\"" : ", \"") + name + "\"";
  return text;
}

void check_log_options(const LogOptions& options) {
  if (options.every_nth_scan < 1) fail("log.every_nth_scan", options.every_nth_scan, "1 or more");
  if (options.field_of_view_rad &&
      !(*options.field_of_view_rad > 0 && *options.field_of_view_rad <= 2 * M_PI)) {
    fail("log.field_of_view_deg", mrpt::RAD2DEG(*options.field_of_view_rad),
         "more than 0 and up to 360 degrees");
  }
  if (!(options.min_range_m >= 0)) fail("log.min_range_m", options.min_range_m, "0 metres or more");
  if (options.max_range_m && !(*options.max_range_m > options.min_range_m))
    fail("log.max_range_m", *options.max_range_m, "more metres than log.min_range_m");
  if (options.sweep_time_s && !(*options.sweep_time_s >= 0 && *options.sweep_time_s <= 1))
    fail("log.sweep_time_s", *options.sweep_time_s, "0 to 1 seconds");
  if (options.robot_T_laser && !is_possible_mount(*options.robot_T_laser))
    fail("the laser's pose on the robot", options.robot_T_laser->asString(),
         "finite numbers and at most 100 m");
  if (options.odometry_scale && !(*options.odometry_scale >= 0.01 && *options.odometry_scale <= 100))
    fail("log.odometry_scale", *options.odometry_scale, "0.01 to 100");
  stated_mounts(options);
  stated_delays(options);
  laser_choice("log.laser", options.laser);
  laser_choice("log.scan_topic", options.scan_topic);
  height_slice(options);
}

}  // namespace psi_slam
