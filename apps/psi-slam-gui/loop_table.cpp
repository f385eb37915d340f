// SPDX-License-Identifier: BSD-3-Clause
#include "loop_table.h"

#include <algorithm>
#include <array>
#include <limits>
#include <tuple>

#include "base/number_text.h"
#include "gui/loop_picture.h"

namespace psi_slam {
namespace {

constexpr std::array<const char*, LoopTable::kColumns> kTitles{
    "Frame",     "Node",      "Map",          "Search", "Response",
    "Ambiguity", "Moved [m]", "Residual [m]", "State",  "Reason"};

}  // namespace

std::string describe_loop(const LoopRecord& loop) {
  const std::string words = "Node " + std::to_string(loop.node) + " on local map " +
                            std::to_string(loop.local_map) + ", " + state_text(loop.state);
  return loop.rejection ? words + ": " + text_of(loop.rejection) : words;
}

const char* LoopTable::title(std::size_t column) {
  return kTitles.at(column);
}

bool LoopTable::show(const std::shared_ptr<const ReplaySnapshot>& snapshot) {
  const bool same =
      snapshot_ && snapshot_->loops == snapshot->loops && snapshot_->map_T_node == snapshot->map_T_node;
  snapshot_ = snapshot;
  if (!same) arrange();
  return !same;
}

void LoopTable::set_filter(std::optional<LoopState> state) {
  filter_ = state;
  arrange();
}

void LoopTable::sort_by(std::size_t column, bool ascending) {
  column_ = column;
  ascending_ = ascending;
  arrange();
}

LoopTable::Cell LoopTable::cell(const LoopRecord& loop, std::size_t column) const {
  const auto number = [](auto value, int decimals) {
    return Cell{static_cast<double>(value), fixed_text(static_cast<double>(value), decimals)};
  };
  const char* const manner = loop.by_hand ? ", by hand" : loop.in_final_search ? ", final" : "";
  if (column == kFrame) return number(loop.frame, 0);
  if (column == kNode) return number(loop.node, 0);
  if (column == kLocalMap) return number(loop.local_map, 0);
  if (column == kSearch) return {0, std::string(name(loop.search)) + manner};
  if (column == kResponse) return number(loop.response, 3);
  if (column == kAmbiguity) return number(loop.ambiguity, 3);
  if (column == kMoved) return number(loop.moved_m, 2);
  if (column == kState) return {0, state_text(loop.state)};
  if (column == kReason) return {0, text_of(loop.rejection)};
  // kResidual: empty for matches that never were constraints of the graph
  if (loop.state == LoopState::kAccepted || is_outlier(loop))
    return number(loop_residual_m(loop, *snapshot_->map_T_node), 3);
  return {std::numeric_limits<double>::infinity() * (ascending_ ? 1 : -1), ""};  // listed last
}

void LoopTable::arrange() {
  order_.clear();
  if (!snapshot_) return;
  const std::vector<LoopRecord>& loops = *snapshot_->loops;
  std::vector<Cell> keys(loops.size());
  for (std::size_t i = 0; i < loops.size(); ++i) {
    if (filter_ && loops[i].state != *filter_) continue;
    order_.push_back(i);
    keys[i] = cell(loops[i], column_);
  }
  const auto before = [&](std::size_t a, std::size_t b) {
    return std::tie(keys[a].number, keys[a].text) < std::tie(keys[b].number, keys[b].text);
  };
  std::stable_sort(order_.begin(), order_.end(),
                   [&](std::size_t a, std::size_t b) { return ascending_ ? before(a, b) : before(b, a); });
}

std::optional<std::size_t> LoopTable::row_of(std::size_t loop) const {
  const auto found = std::find(order_.begin(), order_.end(), loop);
  if (found == order_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - order_.begin());
}

std::string LoopTable::text(std::size_t row, std::size_t column) const {
  return cell(loop(row), column).text;
}

std::string LoopTable::summary() const {
  if (!snapshot_ || snapshot_->loops->empty()) return "No loop has been searched yet";
  std::string text = std::to_string(snapshot_->loops->size()) + " searches:";
  const char* comma = " ";
  for (const LoopState state : kLoopStates) {
    const auto count = std::count_if(snapshot_->loops->begin(), snapshot_->loops->end(),
                                     [&](const LoopRecord& loop) { return loop.state == state; });
    if (count == 0) continue;
    text += comma + std::to_string(count) + ' ' + state_text(state);
    comma = ", ";
  }
  return text;
}

}  // namespace psi_slam
