// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/csv_tables.h"

#include <cmath>
#include <initializer_list>
#include <optional>

#include "base/number_text.h"
#include "pose_graph/placed_covariances.h"

namespace psi_slam {
namespace {

constexpr const char* kFramesHeader =
    "frame,time_s,odom_x_m,odom_y_m,odom_theta_rad,front_end_x_m,front_end_y_m,front_end_theta_rad,"
    "map_x_m,map_y_m,map_theta_rad,node,response,window_x_m,window_y_m,window_theta_rad,"
    "psi,eta,mean_loops,loops_tried,loops_accepted,matcher,loop_evaluations,evaluations,front_end_ms,"
    "loop_matching_ms,loop_closing_ms,pose_graph_ms,matched,searched_loops";
constexpr const char* kTrajectoryHeader =
    "time_s,x_m,y_m,theta_rad,cov_xx_m2,cov_xy_m2,cov_xtheta_m_rad,cov_yy_m2,cov_ytheta_m_rad,"
    "cov_thetatheta_rad2,run\n";
constexpr const char* kLoopsHeader =
    "frame,node,local_map,anchor,state,reason,matcher,in_last_pass,by_hand,x_m,y_m,theta_rad,std_x_m,"
    "std_y_m,std_theta_rad,window_x_m,window_y_m,window_theta_rad,response,ambiguity,observed_share,"
    "neighbours_agree,reverse_agree,moved_m,evaluations,milliseconds,search\n";

/// Returns the header of frames.csv. Its last columns have the number of searches of each kind.
std::string frames_header() {
  std::string header = kFramesHeader;
  for (const SearchKind search : kSearchKinds) header += std::string(",") + name(search) + "_searches";
  return header + '\n';
}

/// Values with a fixed number of decimals, each preceded by a comma.
std::string values(std::initializer_list<double> numbers, int decimals) {
  std::string text;
  for (const double number : numbers) text += ',' + fixed_text(number, decimals);
  return text;
}

std::string values(const mrpt::math::TPose2D& pose) {
  return values({pose.x, pose.y, pose.phi}, 6);
}

/// The six different elements of a covariance matrix, each preceded by a comma; empty if it is unknown.
std::string covariance_values(const std::optional<Eigen::Matrix3d>& covariance) {
  if (!covariance) return ",,,,,,";
  const Eigen::Matrix3d& c = *covariance;
  return values({c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)}, 10);
}

const char* matched_text(ScanMatch match) {
  return match == ScanMatch::kNoMap ? "" : match == ScanMatch::kMatched ? "1" : "0";
}

std::string frame_row(std::size_t index, const FrameRecord& frame) {
  std::string searches;
  for (const int count : frame.searches) searches += ',' + std::to_string(count);
  return std::to_string(index) + ',' + format_seconds(frame.time_us) + values(frame.odom_T_robot) +
         values(frame.front_end_T_robot) + values(frame.map_T_robot) + ',' +
         (frame.node ? std::to_string(*frame.node) : "") +
         values({frame.response, frame.window.x_m, frame.window.y_m, frame.window.theta_rad, frame.psi,
                 frame.eta, frame.mean_loops},
                4) +
         ',' + std::to_string(frame.loops_tried) + ',' + std::to_string(frame.loops_accepted) + ',' +
         (frame.matcher ? name(*frame.matcher) : "") + ',' + std::to_string(frame.loop_evaluations) + ',' +
         std::to_string(frame.evaluations) +
         values({frame.front_end_ms, frame.loop_matching_ms, frame.loop_closing_ms, frame.pose_graph_ms}, 4) +
         ',' + matched_text(frame.match) + (frame.searched_loops ? ",1" : ",0") + searches + '\n';
}

std::string loop_row(const LoopRecord& loop) {
  const auto deviation = [&](int i) { return std::sqrt(loop.covariance(i, i)); };
  return std::to_string(loop.frame) + ',' + std::to_string(loop.node) + ',' + std::to_string(loop.local_map) +
         ',' + std::to_string(loop.anchor) + ',' + state_text(loop.state) + ',' +
         csv_field(text_of(loop.rejection)) + ',' + name(loop.matcher) +
         (loop.in_final_search ? ",1" : ",0") + (loop.by_hand ? ",1" : ",0") + values(loop.anchor_T_node) +
         values({deviation(0), deviation(1), deviation(2)}, 6) +
         values({loop.window.x_m, loop.window.y_m, loop.window.theta_rad, loop.response, loop.ambiguity,
                 loop.observed_share, loop.neighbours_agree, loop.reverse_agree, loop.moved_m},
                4) +
         ',' + std::to_string(loop.evaluations) + values({loop.milliseconds}, 4) + ',' + name(loop.search) +
         '\n';
}

}  // namespace

std::string csv_field(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? "\"\"" : std::string(1, c);
  return quoted + '"';
}

std::string frames_csv(const std::vector<FrameRecord>& frames) {
  std::string text = frames_header();
  text.reserve(text.size() + frames.size() * 220);
  for (std::size_t i = 0; i < frames.size(); ++i) text += frame_row(i, frames[i]);
  return text;
}

std::vector<std::optional<Eigen::Matrix3d>> frame_covariances(const MappingResult& result) {
  const std::vector<std::optional<Eigen::Matrix3d>> of_nodes = placed_covariances(result.graph);
  std::vector<std::optional<Eigen::Matrix3d>> of_frames(result.frames.size());
  if (of_nodes.empty()) return of_frames;
  std::size_t node = 0;
  for (std::size_t i = 0; i < of_frames.size(); ++i) {
    while (node + 1 < result.node_frames.size() && result.node_frames[node + 1] <= i) ++node;
    of_frames[i] = of_nodes[node];
  }
  return of_frames;
}

std::string trajectory_csv(const MappingResult& result) {
  const std::vector<std::optional<Eigen::Matrix3d>> covariances = frame_covariances(result);
  const std::vector<FrameSpan> logs = logs_of(result);
  std::string text = kTrajectoryHeader;
  text.reserve(text.size() + result.frames.size() * 130);
  std::size_t log = 0;
  for (std::size_t i = 0; i < result.frames.size(); ++i) {
    while (log + 1 < logs.size() && logs[log + 1].begin <= i) ++log;
    text += format_seconds(result.frames[i].time_us) + values(result.frames[i].map_T_robot) +
            covariance_values(covariances[i]) + ',' + std::to_string(log + 1) + '\n';
  }
  return text;
}

std::string loops_csv(const std::vector<LoopRecord>& loops) {
  std::string text = kLoopsHeader;
  for (const LoopRecord& loop : loops) text += loop_row(loop);
  return text;
}

}  // namespace psi_slam
