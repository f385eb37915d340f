// SPDX-License-Identifier: BSD-3-Clause
#include "loop_inspector.h"

#include <wx/button.h>
#include <wx/choice.h>
#include <wx/menu.h>
#include <wx/sizer.h>
#include <wx/splitter.h>

#include <algorithm>
#include <array>
#include <utility>

#include "gui/palette.h"
#include "loop_canvas.h"
#include "main_menu.h"
#include "wx_text.h"

namespace psi_slam {
namespace {

/// The widest usual text of each column.
constexpr std::array<const char*, LoopTable::kColumns> kWidest{
    "00000", "0000", "000", "coarse_genetic, final", "0.000", "0.000", "00.00", "0.000", "candidate", ""};
constexpr int kNarrowestReason = 150;
constexpr int kPictureWidth = 330;
constexpr int kScrollBar = 16;
constexpr int kCellMargin = 14;    // added to the width of a text
constexpr int kButtonMargin = 14;  // added to the best width of a button
constexpr const char* kNothingSelected = "Select a loop to see its scan on its local map.";

}  // namespace

LoopList::LoopList(wxWindow* parent)
    : wxListCtrl(parent, wxID_ANY, wxDefaultPosition, wxDefaultSize,
                 wxLC_REPORT | wxLC_VIRTUAL | wxLC_SINGLE_SEL | wxLC_HRULES) {
  SetName("loops");
  for (std::size_t column = 0; column < LoopTable::kColumns; ++column) {
    const bool is_text = column == LoopTable::kSearch || column >= LoopTable::kState;
    const int width = std::max(GetTextExtent(LoopTable::title(column)).GetWidth(),
                               GetTextExtent(kWidest[column]).GetWidth());
    AppendColumn(LoopTable::title(column), is_text ? wxLIST_FORMAT_LEFT : wxLIST_FORMAT_RIGHT,
                 width + FromDIP(kCellMargin));
  }
  Bind(wxEVT_SIZE, &LoopList::fit_columns, this);
  for (wxWindow* child : GetChildren()) child->Bind(wxEVT_MOTION, &LoopList::show_tip, this);
}

void LoopList::fit_columns(wxSizeEvent& event) {
  event.Skip();
  int left = GetSize().GetWidth() - FromDIP(kScrollBar);
  for (std::size_t column = 0; column + 1 < LoopTable::kColumns; ++column)
    left -= GetColumnWidth(static_cast<int>(column));
  const int width = std::max(left, FromDIP(kNarrowestReason));
  if (width != GetColumnWidth(LoopTable::kReason)) SetColumnWidth(LoopTable::kReason, width);
}

void LoopList::show_tip(wxMouseEvent& event) {
  event.Skip();
  auto* const target = static_cast<wxWindow*>(event.GetEventObject());
  int flags = 0;
  const long row = HitTest(event.GetPosition(), flags);
  const wxString reason = OnGetItemText(row, LoopTable::kReason);
  const bool cut =
      GetTextExtent(reason).GetWidth() + FromDIP(kCellMargin) > GetColumnWidth(LoopTable::kReason);
  const wxString tip = cut ? reason : wxString();
  if (target->GetToolTipText() != tip) target->SetToolTip(tip);
}

wxString LoopList::OnGetItemText(long row, long column) const {
  if (row < 0 || static_cast<std::size_t>(row) >= table.rows()) return "";
  return text_of(table.text(static_cast<std::size_t>(row), static_cast<std::size_t>(column)));
}

wxListItemAttr* LoopList::OnGetItemAttr(long row) const {
  if (row < 0 || static_cast<std::size_t>(row) >= table.rows()) return nullptr;
  attribute_.SetTextColour(colour_of(state_colour(table.loop(static_cast<std::size_t>(row)))));
  return &attribute_;
}

LoopInspector::LoopInspector(wxWindow* parent, std::function<void(std::optional<std::size_t>)> on_chosen)
    : wxPanel(parent), on_chosen_(std::move(on_chosen)) {
  const int gap = FromDIP(4);
  filter_ = new wxChoice(this, wxID_ANY);
  filter_->Append("All");
  for (const LoopState state : kLoopStates) filter_->Append(wxString(state_text(state)).Capitalize());
  filter_->SetSelection(0);
  filter_->SetToolTip("List only loops in this state");
  filter_->Bind(wxEVT_CHOICE, [this](wxCommandEvent&) { filter(); });
  summary_ = new wxStaticText(this, wxID_ANY, "", wxDefaultPosition, wxDefaultSize,
                              wxST_NO_AUTORESIZE | wxST_ELLIPSIZE_END);
  auto* row = new wxBoxSizer(wxHORIZONTAL);
  row->Add(filter_, 0, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  row->Add(summary_, 1, wxALIGN_CENTRE_VERTICAL | wxALL, gap);
  add_action(*row, kDeleteLoop, "Delete", "Remove the selected loop from the graph (Delete)");
  add_action(*row, kForceLoop, "Force", "Put the selected loop into the graph and never reject it");
  add_action(*row, kMatchLoop, "Match again", "Match the selected scan and local map with another matcher");
  add_action(*row, kRestoreLoop, "Restore", "Undo all edits of the selected loop");
  add_action(*row, kAddLoop, "Add…", "Add a loop by two clicks on the same object in the map (L)");
  row->AddSpacer(gap);

  splitter_ = new wxSplitterWindow(this, wxID_ANY, wxDefaultPosition, wxDefaultSize, wxSP_LIVE_UPDATE);
  list_ = new LoopList(splitter_);
  canvas_ = new LoopCanvas(splitter_);
  canvas_->Hide();
  splitter_->SetMinimumPaneSize(FromDIP(240));
  splitter_->Initialize(list_);
  splitter_->SetSashGravity(1);
  details_ = new wxStaticText(this, wxID_ANY, kNothingSelected, wxDefaultPosition, wxDefaultSize,
                              wxST_NO_AUTORESIZE | wxST_ELLIPSIZE_END);
  auto* column = new wxBoxSizer(wxVERTICAL);
  column->Add(row, 0, wxEXPAND);
  column->Add(splitter_, 1, wxEXPAND);
  column->Add(details_, 0, wxEXPAND | wxALL, gap);
  SetSizer(column);

  list_->Bind(wxEVT_LIST_ITEM_SELECTED, [this](wxListEvent& event) {
    if (!selecting_) choose(list_->table.loop_of(static_cast<std::size_t>(event.GetIndex())));
  });
  list_->Bind(wxEVT_LIST_COL_CLICK, [this](wxListEvent& event) { sort(event.GetColumn()); });
  show_nothing();
}

void LoopInspector::add_action(wxSizer& row, int command, const char* label, const char* tip) {
  auto* const button =
      new wxButton(this, command, wxString::FromUTF8(label), wxDefaultPosition, wxDefaultSize, wxBU_EXACTFIT);
  button->SetMinSize(wxSize(button->GetBestSize().GetWidth() + FromDIP(kButtonMargin), -1));
  button->SetToolTip(tip);
  button->Bind(wxEVT_BUTTON, [this, command, button](wxCommandEvent&) {
    if (command != kMatchLoop) return choose_command(*this, command);
    wxMenu menu;
    for (std::size_t i = 0; i < kMatcherKinds.size(); ++i)
      menu.Append(kMatchLoopBy + static_cast<int>(i), kMatcherTitles[i]);
    const int chosen = GetPopupMenuSelectionFromUser(menu, button->GetPosition());
    if (chosen != wxID_NONE) choose_command(*this, chosen);
  });
  row.Add(button, 0, wxALIGN_CENTRE_VERTICAL | wxLEFT, FromDIP(3));
}

void LoopInspector::enable_action(int command, bool enabled) {
  if (wxWindow* const button = FindWindow(command)) button->Enable(enabled);
}

void LoopInspector::show(const std::shared_ptr<const ReplaySnapshot>& snapshot) {
  const bool same_loops = snapshot_->loops == snapshot->loops;
  snapshot_ = snapshot;
  if (!same_loops) find_chosen();
  if (list_->table.show(snapshot)) refresh_rows();
}

/// Finds the selected loop again after the list of loops has changed. Shows the loop's picture again if its
/// state or pose has changed.
void LoopInspector::find_chosen() {
  if (!chosen_) return;
  const std::vector<LoopRecord>& loops = *snapshot_->loops;
  const auto is_chosen = [&](const LoopRecord& loop) {
    return loop.frame == chosen_->frame && loop.local_map == chosen_->local_map;
  };
  if (const LoopRecord* const now = selected_loop(); now != nullptr && is_chosen(*now)) {
    if (now->state == chosen_->state && now->anchor_T_node == chosen_->anchor_T_node) return;
  } else {
    const auto found = std::find_if(loops.rbegin(), loops.rend(), is_chosen);
    selected_.reset();
    if (found != loops.rend()) selected_ = static_cast<std::size_t>(loops.rend() - found) - 1;
    scroll_to_selected_ = selected_.has_value();
  }
  if (!selected_) return;
  chosen_ = loops[*selected_];
  canvas_->show(loop_picture(*snapshot_, *selected_));
}

const LoopRecord* LoopInspector::selected_loop() const {
  return selected_ && *selected_ < snapshot_->loops->size() ? &(*snapshot_->loops)[*selected_] : nullptr;
}

void LoopInspector::show_nothing() {
  choose(std::nullopt);
  show(std::make_shared<ReplaySnapshot>());
}

void LoopInspector::choose(std::optional<std::size_t> loop) {
  selected_ = loop;
  chosen_.reset();
  if (selected_loop() != nullptr) chosen_ = *selected_loop();
  canvas_->show(loop ? loop_picture(*snapshot_, *loop) : std::nullopt);
  if (!loop)
    splitter_->Unsplit(canvas_);
  else if (!splitter_->IsSplit())
    splitter_->SplitVertically(list_, canvas_, -FromDIP(kPictureWidth));
  describe();
  on_chosen_(loop);
}

void LoopInspector::describe() {
  const LoopRecord* const loop = selected_loop();
  const wxString text = loop != nullptr ? text_of(describe_loop(*loop)) : wxString(kNothingSelected);
  if (details_->GetLabel() == text) return;
  details_->SetLabel(text);
  details_->SetToolTip(text);
}

void LoopInspector::select(std::optional<std::size_t> loop) {
  choose(loop);
  refresh_rows();
  const auto row = loop ? list_->table.row_of(*loop) : std::nullopt;
  if (row) list_->EnsureVisible(static_cast<long>(*row));
}

void LoopInspector::sort(int column) {
  if (column < 0) return;
  const auto by = static_cast<std::size_t>(column);
  const bool ascending = list_->table.sorted_by() != by || !list_->table.ascending();
  list_->table.sort_by(by, ascending);
  list_->ShowSortIndicator(column, ascending);
  refresh_rows();
}

void LoopInspector::filter() {
  const int choice = filter_->GetSelection();
  list_->table.set_filter(choice <= 0 ? std::nullopt
                                      : std::optional(kLoopStates.at(static_cast<std::size_t>(choice - 1))));
  refresh_rows();
}

/// Updates the rows. The same loop stays selected, and stays in view if it was in view.
void LoopInspector::refresh_rows() {
  selecting_ = true;
  const long before = list_->GetNextItem(-1, wxLIST_NEXT_ALL, wxLIST_STATE_SELECTED);
  const long top = list_->GetTopItem();
  const bool visible = before >= top && before < top + list_->GetCountPerPage();
  list_->SetItemCount(static_cast<long>(list_->table.rows()));
  list_->OnInternalIdle();  // arranges the rows now, because a window that draws a live map is seldom idle
  const auto row = selected_ ? list_->table.row_of(*selected_) : std::nullopt;
  const bool still_listed = before >= 0 && before < list_->GetItemCount();
  if (still_listed && (!row || before != static_cast<long>(*row)))
    list_->SetItemState(before, 0, wxLIST_STATE_SELECTED);
  if (row) list_->SetItemState(static_cast<long>(*row), wxLIST_STATE_SELECTED, wxLIST_STATE_SELECTED);
  if (row && (std::exchange(scroll_to_selected_, false) || (visible && before != static_cast<long>(*row))))
    list_->EnsureVisible(static_cast<long>(*row));
  selecting_ = false;
  list_->Refresh();
  describe();
  const wxString summary = text_of(list_->table.summary());
  if (summary_->GetLabel() != summary) summary_->SetLabel(summary);
}

}  // namespace psi_slam
