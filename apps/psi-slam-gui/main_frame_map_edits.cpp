// SPDX-License-Identifier: BSD-3-Clause
// Tools of the menu Edit > Map, which edit the drawn map by clicks.
#include <algorithm>
#include <cmath>

#include "gui/palette.h"
#include "main_frame.h"
#include "main_menu.h"
#include "map_canvas.h"
#include "message_bar.h"

namespace psi_slam {
namespace {

constexpr double kPointsPerMetre = 1000;  // points are rounded, so that files of edits are easy to read

std::size_t tool_of(MapEdit::Kind kind) {
  const auto* const tool = std::find_if(kMapTools.begin(), kMapTools.end(),
                                        [kind](const MapTool& each) { return each.kind == kind; });
  return static_cast<std::size_t>(tool - kMapTools.begin());
}

std::string hint_of(MapEdit::Kind kind) {
  const bool line = kind == MapEdit::Kind::kWall;
  return std::string(kMapTools.at(tool_of(kind)).name) + ": click its " + (line ? "points" : "corners") +
         ". Enter, a double click or a right click ends the " + (line ? "wall" : "polygon") +
         ", Backspace removes the last point, Esc cancels";
}

/// Returns the limit of the last slow zone, whose kind all slow zones must have; 30 % if there is none.
SpeedLimit last_limit(const std::vector<MapEdit>& edits) {
  SpeedLimit limit;
  for (const MapEdit& edit : edits)
    if (edit.kind == MapEdit::Kind::kSlow) limit = {edit.percent, edit.max_speed_mps};
  return limit;
}

}  // namespace

void MainFrame::bind_map_tools() {
  for (std::size_t i = 0; i < kMapTools.size(); ++i)
    on(kMapTool + static_cast<int>(i), [this, i] { choose_map_tool(kMapTools[i].kind); });
  on(kMapEdits, [this] { show_map_menu(); });
  canvas_->on.closed = [this] { close_draft(); };
}

void MainFrame::show_map_menu() {
  const std::unique_ptr<wxMenu> menu(make_map_menu());
  if (draft_) menu->Check(kMapTool + static_cast<int>(tool_of(draft_->kind)), true);
  PopupMenu(menu.get());
}

void MainFrame::choose_map_tool(MapEdit::Kind kind) {
  if (!run_.snapshot || run_.snapshot->frames.size() == 0) return;
  const bool was_chosen = draft_ && draft_->kind == kind;
  stop_pointing();
  if (was_chosen) return;
  MapEdit draft;
  draft.kind = kind;
  draft.frame_T_robot = run_.snapshot->frames[0].map_T_robot;  // the window shows the frame of the mapper
  if (kind == MapEdit::Kind::kSlow) {
    const auto limit = ask_for_speed_(last_limit(run_.snapshot->edits->map_edits()));
    if (!limit) return;
    draft.percent = limit->percent;
    draft.max_speed_mps = limit->max_speed_mps;
  }
  draft_ = draft;
  canvas_->set_pointing(true);
  GetMenuBar()->Check(kMapTool + static_cast<int>(tool_of(kind)), true);
  show_status(hint_of(kind));
}

void MainFrame::add_point(const mrpt::math::TPoint2D& place) {
  const auto rounded = [](double metres) { return std::round(metres * kPointsPerMetre) / kPointsPerMetre; };
  draft_->points.emplace_back(rounded(place.x), rounded(place.y));
  show_draft();
}

void MainFrame::remove_last_point() {
  if (!draft_->points.empty()) draft_->points.pop_back();
  show_draft();
}

void MainFrame::show_draft() {
  canvas_->show_draft({draft_->points, draft_->kind != MapEdit::Kind::kWall, map_edit_colour(draft_->kind)});
}

void MainFrame::close_draft() {
  if (!draft_ || !replay_) return;
  if (run_.snapshot->phase == ReplayPhase::kFailed) {
    stop_pointing();
    return show_status("The run has failed, so the drawing was discarded");
  }
  const std::size_t least = least_points(draft_->kind);
  if (draft_->points.size() < least)
    return show_status("Click at least " + std::to_string(least) +
                       " points before you end the drawing (Esc cancels)");
  const MapEdit edit = *draft_;
  stop_pointing();
  replay_->edit(edit);
}

bool MainFrame::serve_drawing_key(int key) {
  if (!draft_) return false;
  if (key == WXK_RETURN || key == WXK_NUMPAD_ENTER)
    close_draft();
  else if (key == WXK_BACK)
    remove_last_point();
  else
    return false;
  return true;
}

}  // namespace psi_slam
