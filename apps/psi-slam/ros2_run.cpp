// SPDX-License-Identifier: BSD-3-Clause
#include "ros2_run.h"

#include <algorithm>
#include <exception>
#include <thread>
#include <utility>

#include "base/number_text.h"
#include "localization/reference_map.h"
#include "map/report/output_folder.h"
#include "map/verdict/map_verdict.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

constexpr auto kPoll = std::chrono::milliseconds(1);
constexpr auto kStatusPeriod = std::chrono::seconds(1);
constexpr auto kGraphPeriod = std::chrono::seconds(5);
constexpr std::size_t kScansOfStatus = 50;  // newest scans, whose matches the status counts

std::vector<Ros2Constraint> constraints_of(const std::vector<LoopRecord>& loops,
                                           const std::vector<TPose2D>& node_poses) {
  std::vector<Ros2Constraint> constraints;
  const auto position = [&](std::size_t node) {
    const TPose2D& pose = node_poses[node];
    return mrpt::math::TPoint2D(pose.x, pose.y);
  };
  for (std::size_t node = 1; node < node_poses.size(); ++node)
    constraints.push_back({position(node - 1), position(node), std::nullopt});
  for (const LoopRecord& loop : loops) {
    const bool is_match = loop.state == LoopState::kAccepted ||
                          (loop.rejection && loop.rejection->reason == LoopRejection::Reason::kContradicted);
    if (is_match && loop.node < node_poses.size() && loop.reference < node_poses.size())
      constraints.push_back({position(loop.reference), position(loop.node), loop.state});
  }
  return constraints;
}

/// Returns the file of a command in the folder of the results. Empty for a name that leads out
/// of it, and for files that the run writes itself.
std::optional<std::filesystem::path> file_of(const std::filesystem::path& folder, const std::string& name,
                                             const std::string& usual) {
  const std::filesystem::path file = name.empty() ? usual : name;
  const bool is_inside = file.filename() == file && file != "." && file != "..";
  const bool is_of_run = OutputFolder::is_result(file.string()) || file.stem() == "map" ||
                         file == journal_of_live_run(folder).filename();
  if (!is_inside || is_of_run) return std::nullopt;
  return folder / file;
}

constexpr const char* kWrongName =
    "expected a file name without / that is not one of the results; the file is written to their folder";

Ros2Status::Level level_of(MapState state) {
  return state == MapState::kGood     ? Ros2Status::Level::kGood
         : state == MapState::kBroken ? Ros2Status::Level::kError
                                      : Ros2Status::Level::kWarning;
}

}  // namespace

LiveControl Ros2Commands::control(LiveControl control) const {
  control.should_stop = [this, stop = std::move(control.should_stop)] {
    return stop() || wish_ != Ros2Wish::kGoOn;
  };
  return control;
}

std::optional<std::string> Ros2Commands::take_common(const std::string& name) {
  if (name == "pause" || name == "resume") {
    link_->pause(name == "pause");
    return name == "pause" ? "scans are ignored until the command resume" : "scans are used";
  }
  if (name != "finish") return std::nullopt;
  wish_ = Ros2Wish::kFinish;
  return "ending the run";
}

std::string Ros2Commands::unknown_text(const std::string& command) {
  return "unknown command \"" + command +
         "\". Expected pause, resume or finish; while mapping also save_map [NAME], save_session [NAME], "
         "reset or "
         "localize";
}

Ros2Run::Ros2Run(std::shared_ptr<Ros2Link> link, Ros2Commands& commands, MappingSession& session,
                 LiveMapping& mapping, std::filesystem::path folder)
    : link_(std::move(link)),
      commands_(commands),
      session_(session),
      mapping_(mapping),
      folder_(std::move(folder)) {}

void Ros2Run::wait_for_scan() {
  bool has_waited = false;
  do {
    commands_.take(
        [this](const std::string& name, const std::string& argument) { return obey(name, argument); });
    const auto now = Clock::now();
    if (now >= status_due_) {
      status_due_ = now + kStatusPeriod;
      publish_status();
    }
    if (has_waited && now >= graph_due_) {
      graph_due_ = now + kGraphPeriod;
      publish_graph();
    }
    if (session_.scan_waits()) return;
    std::this_thread::sleep_for(kPoll);
    has_waited = true;
  } while (true);
}

std::optional<std::string> Ros2Run::obey(const std::string& name, const std::string& argument) {
  if (name == "reset" || name == "localize") {
    commands_.set_wish(name == "reset" ? Ros2Wish::kReset : Ros2Wish::kLocalize);
    return name == "reset" ? "dropping the map and starting a new one"
                           : "finishing the map, then localizing in it";
  }
  if (name != "save_map" && name != "save_session") return std::nullopt;
  const bool is_map = name == "save_map";
  auto file = file_of(folder_, argument, is_map ? "saved_map" : "saved.session");
  if (!file) return kWrongName;
  try {
    if (is_map) {
      if (file->extension() != ".yaml") *file += ".yaml";
      mapping_.save_map(*file);
    } else {
      session_.save(*file);
    }
  } catch (const std::exception& error) {
    return std::string("failed: ") + error.what();
  }
  return "wrote " + file->string();
}

void Ros2Run::publish_status() const {
  const std::vector<FrameRecord>& frames = session_.mapper().frames();
  Ros2Status status;
  const std::size_t newest = std::min(frames.size(), kScansOfStatus);
  const auto matched = static_cast<std::size_t>(
      std::count_if(frames.end() - static_cast<std::ptrdiff_t>(newest), frames.end(),
                    [](const FrameRecord& record) { return record.match != ScanMatch::kUnmatched; }));
  std::size_t loops = 0;
  for (const FrameRecord& record : frames) loops += static_cast<std::size_t>(record.loops_accepted);
  const bool is_lost = newest == kScansOfStatus && 2 * matched < newest;
  status.level = is_lost ? Ros2Status::Level::kWarning : Ros2Status::Level::kGood;
  status.sentence = frames.empty() ? "waiting for scans"
                    : is_lost      ? "most of the newest scans do not match the map"
                                   : "mapping";
  status.values = {{"scans", std::to_string(frames.size())},
                   {"nodes", std::to_string(session_.mapper().node_poses().size())},
                   {"loops", std::to_string(loops)},
                   {"matched of the newest " + std::to_string(newest) + " scans", std::to_string(matched)}};
  if (!frames.empty()) {
    status.values.emplace_back("response of the newest scan", trimmed_text(frames.back().response, 3));
    status.values.emplace_back("psi", trimmed_text(frames.back().psi, 3));
    status.values.emplace_back("front end, milliseconds", trimmed_text(frames.back().front_end_ms, 2));
  }
  link_->publish_status(status);
}

void Ros2Run::publish_graph() const {
  const Mapper& mapper = session_.mapper();
  if (mapper.frames().empty()) return;
  const std::vector<TPose2D>& node_poses = mapper.node_poses();
  std::vector<std::pair<TimeUs, TPose2D>> trajectory;
  for (const FrameRecord& record : mapper.frames())
    if (record.node && *record.node < node_poses.size())
      trajectory.emplace_back(record.time_us, node_poses[*record.node]);
  link_->publish_trajectory(trajectory);
  link_->publish_constraints(constraints_of(mapper.loops(), node_poses));
}

void Ros2Run::publish_result(Ros2Link& link, MappingSession& session, const RunSummary& summary,
                             const std::filesystem::path& folder) {
  std::vector<std::pair<TimeUs, TPose2D>> trajectory;
  session.read_exported([&](const MappingResult& result) {
    std::vector<TPose2D> node_poses;
    for (const std::size_t frame : result.node_frames) node_poses.push_back(result.frames[frame].map_T_robot);
    for (const FrameRecord& record : result.frames)
      trajectory.emplace_back(record.time_us, record.map_T_robot);
    link.publish_constraints(constraints_of(result.loops, node_poses));
  });
  link.publish_trajectory(trajectory);
  if (std::filesystem::exists(folder / "map.yaml")) link.publish_map(read_map_file(folder / "map.yaml"));
  Ros2Status status;
  status.sentence = "finished";
  if (summary.verdict) {
    status.level = level_of(summary.verdict->state);
    status.sentence = verdict_sentence(*summary.verdict);
  }
  link.publish_status(status);
}

}  // namespace psi_slam
