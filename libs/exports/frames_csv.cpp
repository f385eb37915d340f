// SPDX-License-Identifier: BSD-3-Clause
#include "exports/frames_csv.h"

#include "base/atomic_file.h"
#include "exports/csv_text.h"
#include "base/number_text.h"

namespace psi_slam {
namespace {

constexpr const char* kHeader =
    "frame,time_s,odom_x_m,odom_y_m,odom_theta_rad,front_end_x_m,front_end_y_m,front_end_theta_rad,"
    "map_x_m,map_y_m,map_theta_rad,node,response,window_x_m,window_y_m,window_theta_rad,"
    "psi,eta,mean_loops,loops_tried,loops_accepted,matcher,loop_evaluations,evaluations,front_end_ms,"
    "loop_matching_ms,loop_closing_ms,pose_graph_ms\n";

std::string row_of(std::size_t index, const FrameRecord& frame) {
  std::string row = std::to_string(index) + ',' + format_seconds(frame.time_us);
  row += ',' + csv_pose(frame.odom_T_robot);
  row += ',' + csv_pose(frame.front_end_T_robot);
  row += ',' + csv_pose(frame.map_T_robot);
  row += ',' + (frame.node ? std::to_string(*frame.node) : "");
  row += ',' + fixed_text(frame.response, 4);
  row += ',' + fixed_text(frame.window.x_m, 4) + ',' + fixed_text(frame.window.y_m, 4) + ',' +
         fixed_text(frame.window.theta_rad, 4);
  for (const double value : {frame.psi, frame.eta, frame.mean_loops}) row += ',' + fixed_text(value, 4);
  row += ',' + std::to_string(frame.loops_tried) + ',' + std::to_string(frame.loops_accepted);
  row += std::string(",") + (frame.matcher ? name(*frame.matcher) : "") + ',' + std::to_string(frame.loop_evaluations) + ',' +
         std::to_string(frame.evaluations);
  for (const double ms :
       {frame.front_end_ms, frame.loop_matching_ms, frame.loop_closing_ms, frame.pose_graph_ms})
    row += ',' + fixed_text(ms, 4);
  return row + '\n';
}

}  // namespace

std::string frames_csv(const std::vector<FrameRecord>& frames) {
  std::string text = kHeader;
  text.reserve(text.size() + frames.size() * 220);
  for (std::size_t i = 0; i < frames.size(); ++i) text += row_of(i, frames[i]);
  return text;
}

void write_frames_csv(const std::filesystem::path& path, const std::vector<FrameRecord>& frames) {
  write_text_atomically(path, frames_csv(frames));
}

}  // namespace psi_slam
