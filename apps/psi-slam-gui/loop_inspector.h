// SPDX-License-Identifier: BSD-3-Clause
// Every match that loop closing made, in a table; the one selected in words below it, and as a picture that
// takes its room from the table only then. What can be done with it stands above.
#pragma once

#include <wx/listctrl.h>
#include <wx/panel.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "loop_table.h"

class wxChoice;
class wxSplitterWindow;
class wxStaticText;

namespace psi_slam {

class LoopActions;
class LoopCanvas;

/// The table itself: rows are asked for as they come into sight.
class LoopList : public wxListCtrl {
 public:
  explicit LoopList(wxWindow* parent);
  LoopTable table;

 private:
  /// The last column takes what the others leave.
  void fit_columns();
  /// All of a text that its column cuts off.
  void show_tip(wxMouseEvent& event);
  wxString OnGetItemText(long row, long column) const override;
  wxListItemAttr* OnGetItemAttr(long row) const override;
  mutable wxListItemAttr attribute_;
};

class LoopInspector : public wxPanel {
 public:
  /// `chosen` is told the index in ReplaySnapshot::loops, or none.
  LoopInspector(wxWindow* parent, std::function<void(std::optional<std::size_t>)> chosen);

  void show(const std::shared_ptr<const ReplaySnapshot>& snapshot);
  void show_nothing();
  void select(std::optional<std::size_t> loop);
  std::optional<std::size_t> selected() const { return selected_; }

  const LoopTable& table() const { return list_->table; }
  const LoopList& list() const { return *list_; }
  const LoopCanvas& canvas() const { return *canvas_; }
  /// What is said of the loop selected.
  std::string details() const;
  LoopActions& actions() { return *actions_; }

 private:
  void choose(std::optional<std::size_t> loop);
  void sort(int column);
  void filter();
  void find_chosen();
  void refresh_rows();
  void describe();
  void show_picture(bool shown);

  std::function<void(std::optional<std::size_t>)> told_chosen_;
  std::shared_ptr<const ReplaySnapshot> snapshot_;
  std::optional<std::size_t> selected_;
  bool selecting_ = false;
  bool lost_sight_ = false;  ///< the selected loop is listed elsewhere now
  /// The scan and the local map selected: the loops' numbers may change when loops are edited.
  std::optional<LoopRecord> chosen_;
  LoopActions* actions_;
  wxChoice* filter_;
  wxStaticText* summary_;
  wxStaticText* details_;
  wxSplitterWindow* splitter_;
  LoopList* list_;
  LoopCanvas* canvas_;
};

}  // namespace psi_slam
