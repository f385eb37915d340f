// SPDX-License-Identifier: BSD-3-Clause
#include "replay/snapshot_maker.h"

#include <algorithm>
#include <utility>

namespace psi_slam {
namespace {

constexpr std::chrono::milliseconds kBetweenActiveMaps{400};

template <class T>
void catch_up(SharedHistory<T>& history, const std::vector<T>& all) {
  while (history.size() < all.size()) history.push_back(all[history.size()]);
}

bool same_poses(const std::vector<mrpt::math::TPose2D>& a, const std::vector<mrpt::math::TPose2D>& b) {
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin());
}

}  // namespace

SnapshotMaker::SnapshotMaker(const PsiThresholds& psi, const std::vector<TimedEdit>& edits) {
  now_.psi = psi;
  now_.edits = std::make_shared<std::vector<TimedEdit>>(edits);
}

void SnapshotMaker::note_save(SaveOutcome outcome) {
  outcome.written.edits = now_.edits;
  now_.saved = std::move(outcome);
}

void SnapshotMaker::note_export(ExportOutcome outcome) {
  outcome.written = {shares_.size(), now_.edits};
  now_.exported = std::move(outcome);
}

void SnapshotMaker::follow(const Mapper& mapper, ActiveMaps active) {
  catch_up(log_, mapper.log());
  catch_up(frames_, mapper.frames());
  now_.later_run_frames = mapper.later_run_frames();
  catch_up(nodes_, mapper.keyframes().nodes);
  follow_local_maps(mapper);
  now_.map_T_robot = mapper.map_T_robot();
  if (!same_poses(*now_.map_T_node, mapper.graph().poses()))
    now_.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(mapper.graph().poses());
  // While scans are mapped, a loop's verdict changes only when another loop comes.
  const bool verdicts_may_change = now_.progress.phase != SessionProgress::Phase::kMapping;
  if (verdicts_may_change || std::exchange(loops_changed_, false) ||
      now_.loops->size() != mapper.loops().size())
    now_.loops = std::make_shared<std::vector<LoopRecord>>(mapper.loops());
  copy_active(mapper, active);
}

void SnapshotMaker::note_edits(const std::vector<TimedEdit>& edits, const EditHistory& history) {
  now_.edits = std::make_shared<std::vector<TimedEdit>>(edits);
  now_.undo_text = history.undo_text();
  now_.redo_text = history.redo_text();
  loops_changed_ = true;
  finished_ = false;
}

void SnapshotMaker::follow_local_maps(const Mapper& mapper) {
  const std::vector<PlacedLocalMap>& all = mapper.keyframes().local_maps;
  for (std::size_t i = local_maps_.size(); i < all.size(); ++i)
    local_maps_.push_back({all[i].anchor, all[i].first_node, all[i].last_node});
}

void SnapshotMaker::copy_active(const Mapper& mapper, ActiveMaps active) {
  const auto time = std::chrono::steady_clock::now();
  if (frames_copied_active_ == frames_.size()) return;
  const bool early = frames_copied_active_ > 0 && time - copied_active_at_ < kBetweenActiveMaps;
  if (early && active == ActiveMaps::kNowAndThen) return;
  frames_copied_active_ = frames_.size();
  copied_active_at_ = time;
  now_.active_local_maps.clear();
  for (const PlacedLocalMap& local_map : mapper.active_local_maps())
    if (local_map.map->occupancy())
      now_.active_local_maps.push_back(
          {local_map.id, local_map.anchor,
           std::make_shared<mrpt::maps::COccupancyGridMap2D>(*local_map.map->occupancy())});
}

void SnapshotMaker::take(const MappingResult& result) {
  finished_ = true;
  SharedHistory<FrameRecord> frames;
  catch_up(frames, result.frames);
  frames_ = std::move(frames);
  std::vector<mrpt::math::TPose2D> poses;
  for (const std::size_t frame : result.node_frames) poses.push_back(result.frames[frame].map_T_robot);
  now_.map_T_node = std::make_shared<std::vector<mrpt::math::TPose2D>>(std::move(poses));
  now_.loops = std::make_shared<std::vector<LoopRecord>>(result.loops);
  now_.active_local_maps.clear();
  if (!result.frames.empty()) now_.map_T_robot = result.frames.back().map_T_robot;
  now_.stages = result.stages;
  now_.interrupted = result.interrupted;
}

std::shared_ptr<const ReplaySnapshot> SnapshotMaker::snapshot(ReplayPhase phase) {
  now_.phase = phase;
  now_.log = log_.view();
  now_.frames = frames_.view();
  now_.shares = shares_.view();
  now_.nodes = nodes_.view();
  now_.local_maps = local_maps_.view();
  return std::make_shared<ReplaySnapshot>(now_);
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
    sketch.map_T_robot = *now_.map_T_node;
  }
  return sketch;
}

}  // namespace psi_slam
