// SPDX-License-Identifier: BSD-3-Clause
// One run of a sweep: psi-slam in a process of its own, and the folder of what it came to.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "batch/run_figures.h"

namespace psi_slam {

/// What is left of a run's files besides summary.json and settings.ini, with which psi-slam makes it again.
enum class SweepKeep {
  kNone,
  kPaths,  ///< trajectories and tables
  kMaps,   ///< everything
};

/// Everything that whoever makes a run has to know, wherever that is.
struct SweepOrder {
  std::filesystem::path program;  ///< psi-slam
  std::filesystem::path log;
  std::filesystem::path relations;  ///< empty: none
  std::string settings;
  std::string key;
  std::filesystem::path folder;  ///< for its results
  SweepKeep keep = SweepKeep::kNone;
};

struct SweepFigures : RunFigures {
  bool has_errors = false;  ///< there are relations to know them by
  std::size_t nodes = 0;
  std::size_t loops_accepted = 0;
  std::size_t loops_refused = 0;
  std::size_t loops_switched_off = 0;
  double path_length_m = 0;
};

struct SweepOutcome {
  std::optional<SweepFigures> figures;
  std::string failure;  ///< why there are none
  int attempts = 0;     ///< made now; 0 where the result was there
};

/// What is in the order's folder, if that holds a finished result of its key with the files to be kept.
std::optional<SweepOutcome> kept_outcome(const SweepOrder& order);

/// Makes the run. Its folder appears when it is finished and replaces one that is there. A process that is
/// killed or crashes is started once more. None, and no folder, once `stop` is true; it is asked a few times
/// a second. Never throws for what goes wrong with the run.
std::optional<SweepOutcome> make_run(const SweepOrder& order, const std::function<bool()>& stop);

/// To and from text, for workers that are elsewhere. Reading throws nlohmann::json::exception for other text.
std::string order_text(const SweepOrder& order);
SweepOrder read_order(const std::string& text);
std::string outcome_text(const SweepOutcome& outcome);
SweepOutcome read_outcome(const std::string& text);

}  // namespace psi_slam
