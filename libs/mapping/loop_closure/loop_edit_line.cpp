// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/loop_closure/loop_edit_line.h"

#include "base/number_text.h"

namespace psi_slam {

std::string loop_edit_line(const LoopEdit& edit) {
  using Kind = LoopEdit::Kind;
  std::string line;
  for (const auto& [text, kind] : kLoopEditVerbs)
    if (kind == edit.kind) line = text;
  line += " scan=" + std::to_string(edit.frame) + " local_map=" + std::to_string(edit.local_map);
  if (edit.kind == Kind::kMatch) line += std::string(" matcher=") + name(edit.matcher);
  if (edit.kind == Kind::kMatch && edit.place)
    line += " x_m=" + exact_text(edit.place->anchor_T_node.x) +
            " y_m=" + exact_text(edit.place->anchor_T_node.y) +
            " yaw_deg=" + exact_degrees_text(edit.place->anchor_T_node.phi) +
            " window_m=" + exact_text(edit.place->window.x_m) +
            " window_deg=" + exact_degrees_text(edit.place->window.theta_rad);
  if (edit.kind == Kind::kForce && edit.of_final_search) line += " attempt=final_search";
  return line;
}

}  // namespace psi_slam
