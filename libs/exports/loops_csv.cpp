// SPDX-License-Identifier: BSD-3-Clause
#include "exports/loops_csv.h"

#include <cmath>

#include "base/atomic_file.h"
#include "exports/csv_text.h"
#include "base/number_text.h"
#include "exports/verdict_text.h"

namespace psi_slam {
namespace {

constexpr const char* kHeader =
    "frame,node,local_map,anchor,verdict,reason,matcher,in_last_pass,by_hand,x_m,y_m,theta_rad,std_x_m,std_y_"
    "m,"
    "std_theta_rad,window_x_m,window_y_m,window_theta_rad,response,ambiguity,observed_share,neighbours_agree,"
    "reverse_agree,moved_m,evaluations,milliseconds\n";

std::string row_of(const LoopRecord& loop) {
  std::string row = std::to_string(loop.frame) + ',' + std::to_string(loop.node) + ',' +
                    std::to_string(loop.local_map) + ',' + std::to_string(loop.anchor);
  row += std::string(",") + verdict_text(loop.verdict) + ',' + csv_field(text_of(loop.refusal)) + ',' +
         name(loop.matcher);
  row += std::string(loop.in_final_search ? ",1," : ",0,") + (loop.by_hand ? "1," : "0,") +
         csv_pose(loop.anchor_T_node);
  for (int i = 0; i < 3; ++i) row += ',' + fixed_text(std::sqrt(loop.covariance(i, i)), 6);
  for (const double value :
       {loop.window.x_m, loop.window.y_m, loop.window.theta_rad, loop.response, loop.ambiguity,
        loop.observed_share, loop.neighbours_agree, loop.reverse_agree, loop.moved_m})
    row += ',' + fixed_text(value, 4);
  return row + ',' + std::to_string(loop.evaluations) + ',' + fixed_text(loop.milliseconds, 4) + '\n';
}

}  // namespace

std::string loops_csv(const std::vector<LoopRecord>& loops) {
  std::string text = kHeader;
  for (const LoopRecord& loop : loops) text += row_of(loop);
  return text;
}

void write_loops_csv(const std::filesystem::path& path, const std::vector<LoopRecord>& loops) {
  write_text_atomically(path, loops_csv(loops));
}

}  // namespace psi_slam
