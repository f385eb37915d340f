// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <wx/listctrl.h>
#include <wx/panel.h>
#include <wx/stattext.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "loop_table.h"

class wxChoice;
class wxSizer;
class wxSplitterWindow;

namespace psi_slam {

class LoopCanvas;

/// The list control of the loops. Asks the table for the text of rows as they become visible.
class LoopList : public wxListCtrl {
 public:
  explicit LoopList(wxWindow* parent);
  LoopTable table;

 private:
  /// Gives the last column the width that the other columns leave.
  void fit_columns(wxSizeEvent& event);
  /// Shows the reason of the row under the pointer as a tooltip if the column is too narrow for the reason.
  void show_tip(wxMouseEvent& event);
  wxString OnGetItemText(long row, long column) const override;
  wxListItemAttr* OnGetItemAttr(long row) const override;
  mutable wxListItemAttr attribute_;
};

/// Table of all matches that loop closing tried, with buttons for edits above it. The selected match is
/// described below the table and shown as a picture beside it.
class LoopInspector : public wxPanel {
 public:
  /// Calls `on_chosen` with the index of the selected loop in ReplaySnapshot::loops, or with nothing when no
  /// loop is selected any more.
  LoopInspector(wxWindow* parent, std::function<void(std::optional<std::size_t>)> on_chosen);

  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot);
  void show_nothing();
  void select(std::optional<std::size_t> loop);
  std::optional<std::size_t> selected() const { return selected_; }
  /// The selected loop, or null.
  const LoopRecord* selected_loop() const;
  /// Enables or disables the button of a command of the Edit menu.
  void enable_action(int command, bool enabled);

  const LoopTable& table() const { return list_->table; }
  const LoopList& list() const { return *list_; }
  const LoopCanvas& canvas() const { return *canvas_; }
  /// The text below the table about the selected loop.
  std::string details() const { return details_->GetLabel().utf8_string(); }

 private:
  void add_action(wxSizer& row, int command, const char* label, const char* tip);
  void choose(std::optional<std::size_t> loop);
  void sort(int column);
  void filter();
  void find_chosen();
  void refresh_rows();
  void describe();

  std::function<void(std::optional<std::size_t>)> on_chosen_;
  std::shared_ptr<const ReplaySnapshot> snapshot_ = std::make_shared<ReplaySnapshot>();
  std::optional<std::size_t> selected_;
  bool selecting_ = false;  ///< true while refresh_rows(), not the user, changes the selection
  bool scroll_to_selected_ = false;
  /// Copy of the selected loop, which identifies the loop after edits have changed the indices of loops.
  std::optional<LoopRecord> chosen_;
  wxChoice* filter_;
  wxStaticText* summary_;
  wxStaticText* details_;
  wxSplitterWindow* splitter_;
  LoopList* list_;
  LoopCanvas* canvas_;
};

}  // namespace psi_slam
