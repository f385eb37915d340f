// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <ostream>

#include "commands.h"
#include "files_to_write.h"
#include "map/exports/zone_files.h"
#include "psi_slam/grid_map.h"
#include "psi_slam/user_error.h"
#include "session/map_frame.h"
#include "session/place_run.h"
#include "session/recorded_settings.h"
#include "session/session_prior.h"

namespace psi_slam {
namespace {

/// Returns the edits of a session that is not the first input. Those of the drawn map follow its run. Says
/// which of them cannot.
EditJournal edits_of_later_run(const SessionInput& input, const std::string& name, const Streams& streams) {
  BoundSettings recorded;
  load_recorded(recorded, input.recording()->facts, name);
  EditJournal edits = input.edits();
  const auto frame = fixed_export_T_map(recorded.settings.map_frame);
  const bool has_prior = !recorded.settings.prior.map.empty();
  if (frame && !has_prior && !edits.knowledge().states_frame()) edits = edits.with_frames(*frame);
  const auto count = [&](const auto& condition) {
    return static_cast<std::size_t>(
        std::count_if(edits.map_edits().begin(), edits.map_edits().end(), condition));
  };
  const auto crops = count([](const MapEdit& edit) { return edit.kind == MapEdit::Kind::kCrop; });
  const auto without_place =
      count([](const MapEdit& edit) { return edit.kind != MapEdit::Kind::kCrop && !follows_run(edit); });
  if (crops > 0)
    streams.err << "psi-slam: " << name
                << ": its crop of the drawn map is left out, because it would cut off "
                << "the other runs. Crop the merged map instead\n";
  if (without_place > 0)
    streams.err << "psi-slam: " << name << ": " << without_place
                << (without_place == 1 ? " edit of the drawn map is" : " edits of the drawn map are")
                << " left out, because the frame of the map, which the walls, known poses or a prior map "
                   "decide, is not "
                << "recorded. Save the session again with psi-slam --resume " << name
                << " -o DIR --save-session FILE, and merge FILE\n";
  return edits;
}

/// Throws UserError if zones of different inputs contradict each other.
void check_zones_of(const std::vector<SessionInput>& inputs) {
  EditJournal all;
  for (std::size_t i = 0; i < inputs.size(); ++i)
    all.add(i == 0 ? inputs[i].edits() : inputs[i].edits().of_run(i, 0, 0));  // without those left out
  try {
    check_zones(all.map_edits());
  } catch (const UserError& error) {
    throw UserError("the zones of these runs cannot be combined: " + std::string(error.what()));
  }
}

/// Opens the inputs. The settings are those of the first session among the inputs, overridden by the command
/// line.
std::vector<SessionInput> open_inputs(const CommandLine& line, BoundSettings& bound, const Streams& streams) {
  std::vector<SessionInput> inputs;
  bool recorded = false;
  for (const std::string& name : line.inputs) {
    inputs.push_back(SessionInput::of_file(name));
    const auto& recording = inputs.back().recording();
    if (recording) warn_of_lost_end(*recording, streams);
    if (recording && !recorded) load_recorded_settings(line, name, recording->facts, bound, streams);
    recorded = recorded || recording;
  }
  // Edits at the end of the first run take effect before the next run begins.
  if (const auto& recording = inputs.front().recording()) {
    const EditJournal& edits = inputs.front().edits();
    if (std::any_of(edits.map_edits().begin(), edits.map_edits().end(),
                    [](const MapEdit& edit) { return edit.kind == MapEdit::Kind::kCrop; }))
      streams.err << "psi-slam: " << line.inputs.front()
                  << ": its crop of the drawn map also cuts off the other runs\n";
    inputs.front() = inputs.front().with_edits(edits.of_run(0, recording->frames.size(), 0));
  }
  for (std::size_t i = 1; i < inputs.size(); ++i)
    if (inputs[i].recording())
      inputs[i] = inputs[i].with_edits(edits_of_later_run(inputs[i], line.inputs[i], streams));
  check_zones_of(inputs);
  load_settings(line, bound, streams);
  for (std::size_t i = 0; i < inputs.size(); ++i)
    if (const auto& recording = inputs[i].recording())
      if (const auto changed = changed_settings_text(line.inputs[i], recording->facts, bound.table))
        streams.err << "psi-slam: " << *changed << '\n';
  for (const SessionInput& input : inputs)
    input.open(log_options(bound.settings));  // reports an unreadable log before any mapping
  return inputs;
}

/// Throws if no loop joins a run to the other runs: SystemFailure after an interrupt, UserError otherwise.
/// `inputs` has the name of the input of each run.
void require_joined(const MappingSession& session, const std::vector<std::string>& inputs,
                    const InterruptSignals& signals) {
  const auto log = unjoined_log(session.result());
  if (!log) return;
  if (signals.came())
    throw SystemFailure("interrupted before a loop joined " + inputs[*log] +
                        " to the other runs. Nothing was merged");
  throw UserError(inputs[*log] +
                  " cannot be merged: no loop joins it to the other runs. Leave it out, "
                  "or check that it passes through the same building");
}

void add_run(MappingSession& session, const SessionInput& input, const CommandLine& line,
             const Settings& settings, const InterruptSignals& signals, WorkProgress progress) {
  const std::string doing = "finding where " + names_of(input.logs()) + " begins";
  progress.show(doing, 0, 1);
  const auto grid = draw_grid_map(session.result().log, mapped_poses(session.result()), settings.map);
  std::optional<mrpt::math::TPose2D> map_T_start;
  if (!line.start.empty()) map_T_start = parse_start(line.start);
  const RunStart start = place_run(session.result(), *grid, input, settings, map_T_start, signals.came(),
                                   [&](double share) { progress.show(doing, share, 1); });
  progress.clear();
  session.begin_run(input, start);
}

}  // namespace

int merge_runs(const CommandLine& line, const Streams& streams) {
  BoundSettings bound;
  std::vector<SessionInput> inputs = open_inputs(line, bound, streams);
  if (!line.start.empty()) parse_start(line.start);
  OutputFolder::check(line.output, line.force);
  check_prior_apart(bound.settings, line.output);
  check_files_to_write(line);
  const InterruptSignals signals;
  for (SessionInput& input : inputs) calibrate(input, bound.settings, line, signals, streams);
  const OutputFolder folder = OutputFolder::prepare(line.output, line.force);
  std::optional<ProgressLine> progress_line;
  MappingSession session(inputs.front(), bound.settings);
  session.stay_open();
  watch(session, signals, line, streams, progress_line);
  session.run(signals.came());
  std::vector<std::string> inputs_of_runs(session.runs(), line.inputs.front());
  for (auto input = inputs.begin() + 1; input != inputs.end(); ++input) {
    if (signals.came()) throw SystemFailure("interrupted before all runs were read. Nothing was merged");
    if (progress_line) progress_line->clear();
    add_run(session, *input, line, bound.settings, signals,
            WorkProgress(progress_line ? &streams.err : nullptr));
    inputs_of_runs.resize(session.runs(), line.inputs[static_cast<std::size_t>(input - inputs.begin())]);
    session.run(signals.came());
    require_joined(session, inputs_of_runs, signals);
  }
  return save_and_export(session, folder, line, streams, progress_line);
}

}  // namespace psi_slam
