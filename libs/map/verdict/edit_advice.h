// SPDX-License-Identifier: BSD-3-Clause
// Chooses the edit of a loop that mends a doubtful place of a map. Each edit is tried on the pose graph
// first. An edit mends a place if the disagreement there falls to half and no other place becomes worse: the
// error of no check elsewhere grows by spot_error_m, and no check that fits is lost.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <tuple>
#include <vector>

#include "map/verdict/edit_trial.h"
#include "map/verdict/map_verdict.h"

namespace psi_slam {

class EditAdvice {
 public:
  /// The arguments must outlive the object.
  EditAdvice(const MappingResult& result, const std::vector<MapView>& views,
             const std::vector<PassCheck>& checks, const VerdictOptions& options);

  /// Adds the edit that mends a hot spot, with its effect, if one does.
  void add_to(HotSpot& spot);

 private:
  struct Candidate {
    LoopEdit edit;
    const PassCheck* check = nullptr;  ///< of a match: of its scan with a view of its local map
    const LoopRecord* loop = nullptr;  ///< of the other edits: the loop that they switch
  };

  const TriedEdit* tried(const Candidate& candidate, const Suspect& suspect);
  std::vector<Candidate> forces_across(const Suspect& suspect) const;
  std::vector<Candidate> matches_across(const HotSpot& spot) const;
  std::optional<std::size_t> local_map_around(std::size_t view, std::size_t last_frame) const;
  bool is_made(const LoopEdit& match) const;
  bool concerns(const PassCheck& check, const HotSpot& spot) const;
  std::optional<double> disagreement_left_m(const TriedEdit& tried, const HotSpot& spot) const;
  void choose(const std::vector<Candidate>& candidates, HotSpot& spot);

  const MappingResult& result_;
  const std::vector<MapView>& views_;
  const std::vector<PassCheck>& checks_;
  const VerdictOptions& options_;
  std::optional<EditTrial> trial_;  ///< from the first edit on
  /// Tried edits by kind, scan, local map and first frame of the suspect.
  std::map<std::tuple<LoopEdit::Kind, std::size_t, std::size_t, std::size_t>, std::optional<TriedEdit>>
      tried_;
};

}  // namespace psi_slam
