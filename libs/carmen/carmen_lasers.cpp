// SPDX-License-Identifier: BSD-3-Clause
#include "carmen/carmen_lasers.h"

#include <algorithm>
#include <limits>
#include <set>

#include "compression/line_reader.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"
#include "carmen/carmen_mount.h"

namespace psi_slam {
namespace {

using Messages = std::set<std::string, std::less<>>;

constexpr std::size_t kLinesOfHead = 500;
constexpr std::size_t kAllLines = std::numeric_limits<std::size_t>::max();

Messages messages_in(const std::filesystem::path& path, std::size_t most_lines) {
  LineReader lines(path);
  Messages found;
  std::string_view line;
  for (std::size_t i = 0; i < most_lines && lines.next_readable(line); ++i) {
    const std::string_view name = line.substr(0, line.find_first_of(" \t"));
    if (found.find(name) == found.end()) found.emplace(name);
  }
  return found;
}

/// The most preferred of the messages that there are; empty if there are none.
std::string first_of(const std::vector<std::string>& preferred, const Messages& found) {
  for (const std::string& name : preferred)
    if (found.count(name) != 0) return name;
  return {};
}

}  // namespace

CarmenLasers::CarmenLasers(const std::filesystem::path& path, const LogOptions& options)
    : path_(path), options_(options) {
  const LaserChoice choice = laser_choice("log.laser", options.laser);
  for (auto& candidates : carmen_lasers_wanted(choice)) slots_.push_back({std::move(candidates), {}});
  for (const StatedMount& mount : stated_mounts(options))
    carmen_laser_messages(mount.name, "log.laser_mounts");
  Messages found = messages_in(path, kLinesOfHead);
  const auto is_missing = [&](const Slot& slot) { return first_of(slot.candidates, found).empty(); };
  const bool names_several = choice.names.size() > 1;
  if (names_several && std::any_of(slots_.begin(), slots_.end(), is_missing))
    found = messages_in(path, kAllLines);
  for (Slot& slot : slots_)
    if (const std::string message = first_of(slot.candidates, found); !message.empty()) choose(slot, message);
  if (names_several) require_all(choice);
}

void CarmenLasers::choose(Slot& slot, const std::string& message) {
  const auto number = static_cast<std::size_t>(&slot - slots_.data());
  slot.laser = Laser{CarmenLaser(message, options_), number, parameters_.size(), false};
  if (starts_with(message, "ROBOTLASER"))
    if (const auto mount = mount_by_robotlaser(path_, message)) slot.laser->laser.set_mount_by_poses(*mount);
}

void CarmenLasers::require_all(const LaserChoice& choice) const {
  const std::string log_laser = "log.laser = \"" + options_.laser + "\"";
  for (std::size_t i = 0; i < slots_.size(); ++i) {
    if (!slots_[i].laser) {
      const Messages found = messages_in(path_, kAllLines);
      std::vector<std::string> lasers;
      for (const std::string& name : carmen_laser_messages(""))
        if (found.count(name) != 0) lasers.push_back(name);
      throw UserError(log_laser + " names \"" + choice.names[i] + "\", which " + path_.string() +
                      " does not have, expected some of its lasers: " + quoted_list(lasers));
    }
    for (std::size_t j = 0; j < i; ++j)
      if (slots_[j].laser->laser.message_name() == slots_[i].laser->laser.message_name())
        throw UserError(log_laser + " names one laser twice: the scans of \"" + choice.names[j] +
                        "\" and \"" + choice.names[i] + "\" are the " +
                        slots_[i].laser->laser.message_name() + " messages of " + path_.string());
  }
}

CarmenLasers::Laser* CarmenLasers::laser_of(std::string_view message) {
  for (Slot& slot : slots_) {
    if (slot.laser && message == slot.laser->laser.message_name()) return &*slot.laser;
    if (slot.laser ||
        std::find(slot.candidates.begin(), slot.candidates.end(), message) == slot.candidates.end())
      continue;
    choose(slot, std::string(message));
    return &*slot.laser;
  }
  return nullptr;
}

bool CarmenLasers::any_known() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.laser.has_value(); });
}

bool CarmenLasers::all_known() const {
  return std::all_of(slots_.begin(), slots_.end(), [](const Slot& slot) { return slot.laser.has_value(); });
}

bool CarmenLasers::any_needs_odometry() const {
  return std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) {
    return slot.laser && starts_with(slot.laser->laser.message_name(), "RAWLASER");
  });
}

std::vector<std::string> CarmenLasers::candidates() const {
  std::vector<std::string> all;
  for (const Slot& slot : slots_) all.insert(all.end(), slot.candidates.begin(), slot.candidates.end());
  return all;
}

}  // namespace psi_slam
