// SPDX-License-Identifier: BSD-3-Clause
// One run of a sweep: psi-slam in a process of its own, and the folder of its results.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "batch/run_figures.h"

namespace psi_slam {

/// Files of a run to keep besides run.json, summary.json and settings.ini.
enum class SweepKeep {
  kNone,
  kPaths,  ///< trajectories and tables
  kMaps,   ///< all files
};

/// Everything that a worker on any machine needs to make a run.
struct SweepOrder {
  std::filesystem::path program;  ///< the psi-slam program
  std::filesystem::path log;
  std::filesystem::path relations;  ///< file with the true relations; empty: none
  std::string settings;
  std::string key;
  std::filesystem::path folder;  ///< folder for the results
  SweepKeep keep = SweepKeep::kNone;
};

struct SweepFigures : RunFigures {
  bool has_errors = false;  ///< whether the log has true relations; if not, `errors` is not set
  std::size_t nodes = 0;
  std::size_t loops_accepted = 0;
  std::size_t loops_rejected = 0;
  double path_length_m = 0;

  /// Calls visit(key, member) for each figure of the map.
  template <class Figures, class Visit>
  static void visit_map(Figures& figures, const Visit& visit) {
    visit("nodes", figures.nodes);
    visit("loops_accepted", figures.loops_accepted);
    visit("loops_rejected", figures.loops_rejected);
    visit("path_length_m", figures.path_length_m);
  }
};

struct SweepOutcome {
  std::optional<SweepFigures> figures;
  std::string failure;  ///< reason why there are no figures
  int attempts = 0;     ///< number of attempts in this sweep; 0: result of an earlier sweep
};

/// Finished result in the folder of the order, if it has the key of the order and all files to keep. Empty
/// otherwise.
std::optional<SweepOutcome> kept_outcome(const SweepOrder& order);

/// Makes the run. The folder of the finished run replaces an older one. Starts the process a second time if
/// it fails for a reason other than wrong input. Calls `stop` a few times a second. If `stop` returns true,
/// returns nothing and leaves no unfinished folder. A failed run throws nothing; its outcome states the
/// reason.
std::optional<SweepOutcome> make_run(const SweepOrder& order, const std::function<bool()>& stop);

}  // namespace psi_slam
