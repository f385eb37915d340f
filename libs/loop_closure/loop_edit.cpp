// SPDX-License-Identifier: BSD-3-Clause
#include "loop_closure/loop_edit.h"

namespace psi_slam {

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
