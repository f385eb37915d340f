// SPDX-License-Identifier: BSD-3-Clause
#include "loop_table.h"

#include <algorithm>
#include <limits>

#include "base/number_text.h"
#include "psi_slam/loop_record.h"
#include "view/loop_residual.h"

namespace psi_slam {
namespace {

constexpr std::array<const char*, LoopTable::kColumns> kTitles{
    "Frame",     "Node",      "Map",          "Matcher", "Response",
    "Ambiguity", "Moved [m]", "Residual [m]", "Verdict", "Reason"};

}  // namespace

std::string loop_words(const LoopRecord& loop) {
  const std::string words = "Node " + std::to_string(loop.node) + " on local map " +
                            std::to_string(loop.local_map) + ", " + verdict_text(loop.verdict);
  return loop.refusal ? words + ": " + text_of(loop.refusal) : words;
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

void LoopTable::set_filter(std::optional<LoopVerdict> verdict) {
  filter_ = verdict;
  arrange();
}

void LoopTable::sort_by(std::size_t column, bool ascending) {
  column_ = column;
  ascending_ = ascending;
  arrange();
}

std::optional<double> LoopTable::residual_m(const LoopRecord& loop) const {
  if (loop.verdict != LoopVerdict::kAccepted && loop.verdict != LoopVerdict::kSwitchedOff)
    return std::nullopt;
  return loop_residual(loop, *snapshot_->map_T_node).distance_m;
}

void LoopTable::arrange() {
  order_.clear();
  if (!snapshot_) return;
  const std::vector<LoopRecord>& loops = *snapshot_->loops;
  for (std::size_t i = 0; i < loops.size(); ++i)
    if (!filter_ || loops[i].verdict == *filter_) order_.push_back(i);
  const auto sort = [&](const auto& key) {
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
      return ascending_ ? key(loops[a]) < key(loops[b]) : key(loops[b]) < key(loops[a]);
    });
  };
  switch (column_) {
    case kFrame:
      return sort([](const LoopRecord& loop) { return loop.frame; });
    case kNode:
      return sort([](const LoopRecord& loop) { return loop.node; });
    case kLocalMap:
      return sort([](const LoopRecord& loop) { return loop.local_map; });
    case kMatcher:
      return sort([](const LoopRecord& loop) { return loop.matcher; });
    case kResponse:
      return sort([](const LoopRecord& loop) { return loop.response; });
    case kAmbiguity:
      return sort([](const LoopRecord& loop) { return loop.ambiguity; });
    case kMoved:
      return sort([](const LoopRecord& loop) { return loop.moved_m; });
    case kResidual: {
      const double last = std::numeric_limits<double>::infinity() * (ascending_ ? 1 : -1);
      return sort([&](const LoopRecord& loop) { return residual_m(loop).value_or(last); });
    }
    case kVerdict:
      return sort([](const LoopRecord& loop) { return std::string(verdict_text(loop.verdict)); });
    case kReason:
      return sort([](const LoopRecord& loop) { return text_of(loop.refusal); });
    default:
      return;
  }
}

std::optional<std::size_t> LoopTable::row_of(std::size_t loop) const {
  const auto found = std::find(order_.begin(), order_.end(), loop);
  if (found == order_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - order_.begin());
}

std::string LoopTable::text(std::size_t row, std::size_t column) const {
  const LoopRecord& loop = this->loop(row);
  switch (column) {
    case kFrame:
      return std::to_string(loop.frame);
    case kNode:
      return std::to_string(loop.node);
    case kLocalMap:
      return std::to_string(loop.local_map);
    case kMatcher:
      return name(loop.matcher) + std::string(loop.by_hand ? ", by hand" : loop.in_final_search ? ", last pass" : "");
    case kResponse:
      return fixed_text(loop.response, 3);
    case kAmbiguity:
      return fixed_text(loop.ambiguity, 3);
    case kMoved:
      return fixed_text(loop.moved_m, 2);
    case kResidual: {
      const std::optional<double> residual = residual_m(loop);
      return residual ? fixed_text(*residual, 3) : "";
    }
    case kVerdict:
      return verdict_text(loop.verdict);
    case kReason:
      return text_of(loop.refusal);
    default:
      return "";
  }
}

std::string LoopTable::summary() const {
  if (!snapshot_ || snapshot_->loops->empty()) return "No place has been seen again yet";
  std::string text = std::to_string(snapshot_->loops->size()) + " searches:";
  const char* comma = " ";
  for (const LoopVerdict verdict : kLoopVerdicts) {
    const auto count = std::count_if(snapshot_->loops->begin(), snapshot_->loops->end(),
                                     [&](const LoopRecord& loop) { return loop.verdict == verdict; });
    if (count == 0) continue;
    text += comma + std::to_string(count) + ' ' + verdict_text(verdict);
    comma = ", ";
  }
  return text;
}

}  // namespace psi_slam
