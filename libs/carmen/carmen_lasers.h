// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <deque>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "carmen/carmen_laser.h"
#include "psi_slam/log_options.h"

namespace psi_slam {

/// Which messages of a CARMEN log are scans that are read, and of which laser. Of the kinds of messages that
/// can hold a laser's scans the first lines of the log decide, else the first message to come.
class CarmenLasers {
 public:
  struct Laser {
    CarmenLaser laser;
    std::size_t number = 0;            ///< as in LaserScan::laser
    std::size_t early_parameters = 0;  ///< PARAM lines that came before the laser was known
    bool began = false;                ///< whether it has scanned
  };

  /// Throws UserError when a laser that CARMEN does not have is wanted, or when one of several is not in the
  /// log.
  CarmenLasers(const std::filesystem::path& path, const LogOptions& options);

  /// The laser whose scans messages of that name are; none, when they are not read.
  Laser* laser_of(std::string_view message);

  bool several() const { return slots_.size() > 1; }
  bool any_known() const;
  bool all_known() const;
  bool any_needs_odometry() const;  ///< RAWLASER

  template <class Do>
  void for_each(Do action) {
    for (Slot& slot : slots_)
      if (slot.laser) action(slot.laser->laser);
  }

  /// Of PARAM lines that came while a laser was not known: whoever is chosen later needs them, too.
  void keep_parameter(std::string_view line) { parameters_.emplace_back(line); }
  const std::deque<std::string>& parameters() const { return parameters_; }

  /// All messages that may hold scans, the preferred first.
  std::vector<std::string> candidates() const;

 private:
  struct Slot {
    std::vector<std::string> candidates;
    std::optional<Laser> laser;
  };

  void choose(Slot& slot, const std::string& message);
  void require_all(const LaserChoice& choice) const;

  std::filesystem::path path_;
  LogOptions options_;
  std::vector<Slot> slots_;
  std::deque<std::string> parameters_;
};

}  // namespace psi_slam
