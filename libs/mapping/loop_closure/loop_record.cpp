// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/loop_record.h"

#include "base/number_text.h"

namespace psi_slam {

std::string text_of(LoopRejection::Reason reason) {
  using Reason = LoopRejection::Reason;
  switch (reason) {
    case Reason::kNothingFound:
      return "no pose in the search window scores high enough";
    case Reason::kLowResponse:
      return "the response is too low";
    case Reason::kAmbiguous:
      return "another place fits, or the place is far from the predicted one";
    case Reason::kUncertainPosition:
      return "the scan does not determine the position";
    case Reason::kUnobserved:
      return "too little of the scan lies in space that the local map observed";
    case Reason::kNeighboursDisagree:
      return "too few points of the neighbouring scans fit the local map";
    case Reason::kReverseDisagrees:
      return "too few points of the local map fit the scan";
    case Reason::kNoConsensus:
      return "too few other matches agree with this match in a wide window";
    case Reason::kContradicted:
      return "the other constraints contradict the loop";
    case Reason::kDeletedByHand:
      return "deleted by hand";
    case Reason::kOtherMatchForced:
      return "another match of the same scan and local map was forced by hand";
    case Reason::kMatchedAgain:
      return "matched again by hand";
    case Reason::kMatchTakenBack:
      return "the match by hand was taken back";
  }
  return {};
}

std::string text_of(const std::optional<LoopRejection>& rejection) {
  using Reason = LoopRejection::Reason;
  if (!rejection) return {};
  const std::string reason = text_of(rejection->reason);
  const std::string value = fixed_text(rejection->value, 2);
  const std::string limit = fixed_text(rejection->limit, 2);
  switch (rejection->reason) {
    case Reason::kNothingFound:
      return reason + ": minimum response " + limit;
    case Reason::kLowResponse:
      return reason + ": " + value + ", minimum " + limit;
    case Reason::kAmbiguous:
      return reason + ": doubt " + value + ", maximum " + limit;
    case Reason::kUncertainPosition:
      return reason + ": standard deviation " + value + " m, maximum " + limit + " m";
    case Reason::kUnobserved:
    case Reason::kNeighboursDisagree:
    case Reason::kReverseDisagrees:
      return reason + ": share " + value + ", minimum " + limit;
    case Reason::kContradicted:
      return reason + " by " + value + " standard deviations, maximum " + limit;
    default:
      return reason;
  }
}

std::string searched_by(const LoopRecord& loop) {
  return std::string(name(loop.matcher)) + " (" + name(loop.search) + ')';
}

std::string text_of(const LoopEdit& edit) {
  const std::string pair =
      "scan " + std::to_string(edit.frame) + " with local map " + std::to_string(edit.local_map);
  switch (edit.kind) {
    case LoopEdit::Kind::kDelete:
      return "delete the loop of " + pair;
    case LoopEdit::Kind::kForce:
      return "force the loop of " + pair;
    case LoopEdit::Kind::kMatch:
      return "match " + pair + " by " + name(edit.matcher);
    case LoopEdit::Kind::kRestore:
      return "restore the loop of " + pair;
  }
  return pair;
}

}  // namespace psi_slam
