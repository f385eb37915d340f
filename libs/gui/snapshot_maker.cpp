// SPDX-License-Identifier: BSD-3-Clause
#include "gui/snapshot_maker.h"

#include <algorithm>

#include "logs/frames/discarded_ranges.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/placed_covariances.h"

namespace psi_slam {
namespace {

constexpr std::chrono::milliseconds kBetweenActiveMaps{400};

template <class T>
void append_new(SharedHistory<T>& history, const std::vector<T>& all) {
  while (history.size() < all.size()) history.push_back(all[history.size()]);
}

}  // namespace

mrpt::math::TPose2D map_T_frame(const ReplaySnapshot& snapshot, std::size_t frame) {
  const bool finished = snapshot.phase == ReplayPhase::kFinished || snapshot.phase == ReplayPhase::kExporting;
  if (finished || snapshot.nodes.empty()) return snapshot.frames[frame].map_T_robot;
  std::size_t node = 0;  // last node whose scan is `frame` or an earlier one
  for (std::size_t end = snapshot.nodes.size(); end - node > 1;) {
    const std::size_t middle = node + (end - node) / 2;
    (snapshot.nodes[middle].frame <= frame ? node : end) = middle;
  }
  const mrpt::math::TPose2D node_T_frame =
      between(snapshot.nodes[node].local_T_robot, snapshot.frames[frame].front_end_T_robot);
  return compose((*snapshot.map_T_node)[node], node_T_frame);
}

SnapshotMaker::SnapshotMaker(const PsiThresholds& psi, const EditJournal& edits, bool live) {
  now.psi = psi;
  now.live = live;
  now.edits = std::make_shared<EditJournal>(edits);
}

void SnapshotMaker::note_save(WriteOutcome outcome) {
  outcome.written.edits = now.edits;
  now.saved = std::move(outcome);
}

void SnapshotMaker::note_export(WriteOutcome outcome) {
  outcome.written = {shares_.size(), now.edits};
  now.exported = std::move(outcome);
}

void SnapshotMaker::follow(const Mapper& mapper, ActiveMaps active) {
  mapper.wait();  // completes the records, which are copied once
  follow_log(mapper.log());
  append_new(frames_, mapper.frames());
  now.later_run_frames = mapper.later_run_frames();
  now.unmatched = std::make_shared<UnmatchedScans>(
      unmatched_scans(mapper.frames(), runs_of(mapper.frames().size(), mapper.later_run_frames())));
  append_new(nodes_, mapper.keyframes().nodes);
  follow_local_maps(mapper);
  now.map_T_robot = mapper.map_T_robot();
  // During the mapping of scans, verdicts change only when a loop is added.
  const bool verdicts_may_change = now.progress.phase != SessionProgress::Phase::kMapping;
  // While scans are mapped, the nodes agree with the pose of the robot.
  const auto& map_T_node = verdicts_may_change ? mapper.graph().poses() : mapper.node_poses();
  if (*now.map_T_node != map_T_node)
    now.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(map_T_node);
  if (verdicts_may_change || std::exchange(loops_changed_, false) ||
      now.loops->size() != mapper.loops().size())
    now.loops = std::make_shared<std::vector<LoopRecord>>(mapper.loops());
  copy_active(mapper, active);
}

// Copies new frames. Copies a block again if the mapper has discarded ranges in it.
void SnapshotMaker::follow_log(const std::vector<Frame>& log) {
  append_new(log_, log);
  for (; (settled_blocks_ + 2) * kHistoryBlock <= log.size(); ++settled_blocks_) {
    const auto begin = log.begin() + static_cast<std::ptrdiff_t>(settled_blocks_ * kHistoryBlock);
    const auto end = begin + static_cast<std::ptrdiff_t>(kHistoryBlock);
    if (!std::all_of(begin, end, has_ranges)) log_.replace_block(settled_blocks_, log);
  }
}

void SnapshotMaker::note_edits(const EditJournal& edits, const EditHistory& history) {
  now.edits = std::make_shared<EditJournal>(edits);
  now.undo_text = history.undo_text();
  now.redo_text = history.redo_text();
}

void SnapshotMaker::note_changed_loops() {
  now.node_covariances = std::make_shared<std::vector<std::optional<Eigen::Matrix3d>>>();
  now.verdict.reset();
  loops_changed_ = true;
  finished_ = false;
}

void SnapshotMaker::follow_local_maps(const Mapper& mapper) {
  const std::vector<PlacedLocalMap>& all = mapper.keyframes().local_maps;
  for (std::size_t i = local_maps_.size(); i < all.size(); ++i)
    local_maps_.push_back({all[i].anchor, all[i].first_node, all[i].last_node});
}

void SnapshotMaker::copy_active(const Mapper& mapper, ActiveMaps active) {
  if (frames_copied_active_ == frames_.size()) return;
  const auto time = std::chrono::steady_clock::now();
  const bool recent = frames_copied_active_ > 0 && time - copied_active_at_ < kBetweenActiveMaps;
  if (recent && active == ActiveMaps::kNowAndThen) return;
  frames_copied_active_ = frames_.size();
  copied_active_at_ = time;
  now.active_local_maps.clear();
  for (const PlacedLocalMap& local_map : mapper.active_local_maps())
    if (local_map.map->occupancy())
      now.active_local_maps.push_back(
          {local_map.id, local_map.anchor,
           std::make_shared<mrpt::maps::COccupancyGridMap2D>(*local_map.map->occupancy())});
}

void SnapshotMaker::take(const MappingResult& result) {
  finished_ = true;
  frames_ = {};
  append_new(frames_, result.frames);
  // Since follow() copied the log, the mapper has straightened scans without odometry and discarded ranges.
  if (std::any_of(result.log.begin(), result.log.end(),
                  [](const Frame& frame) { return !frame.has_odometry || !has_ranges(frame); })) {
    log_ = {};
    append_new(log_, result.log);
  }
  now.unmatched = std::make_shared<UnmatchedScans>(unmatched_scans(result.frames, runs_of(result)));
  std::vector<mrpt::math::TPose2D> poses;
  for (const std::size_t frame : result.node_frames) poses.push_back(result.frames[frame].map_T_robot);
  now.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(std::move(poses));
  now.node_covariances =
      std::make_shared<std::vector<std::optional<Eigen::Matrix3d>>>(placed_covariances(result.graph));
  now.verdict = std::make_shared<MapVerdict>(judge_map(result));
  now.loops = std::make_shared<std::vector<LoopRecord>>(result.loops);
  now.active_local_maps.clear();
  if (!result.frames.empty()) now.map_T_robot = result.frames.back().map_T_robot;
  now.stages = result.stages;
  now.interrupted = result.interrupted;
}

std::shared_ptr<const ReplaySnapshot> SnapshotMaker::snapshot(ReplayPhase phase) {
  now.phase = phase;
  now.log = log_.view();
  now.frames = frames_.view();
  now.shares = shares_.view();
  now.nodes = nodes_.view();
  now.local_maps = local_maps_.view();
  return std::make_shared<ReplaySnapshot>(now);
}

MapSketch SnapshotMaker::sketch() const {
  MapSketch sketch;
  sketch.log = log_.view();
  if (finished_) {
    const HistoryView<FrameRecord> frames = frames_.view();
    for (std::size_t i = 0; i < frames.size(); ++i) {
      sketch.frames.push_back(i);
      sketch.map_T_robot.push_back(frames[i].map_T_robot);
    }
  } else {
    const HistoryView<NodeScan> nodes = nodes_.view();
    for (std::size_t i = 0; i < nodes.size(); ++i) sketch.frames.push_back(nodes[i].frame);
    sketch.map_T_robot = *now.map_T_node;
  }
  return sketch;
}

}  // namespace psi_slam
