// SPDX-License-Identifier: BSD-3-Clause
#include "session/session_recording.h"

#include <algorithm>

namespace psi_slam {
namespace {

EditJournal edits_before(std::size_t scan, const EditJournal& edits) {
  EditJournal before;
  for (const TimedEdit& edit : edits.edits())
    if (edit.edit.frame < scan) before.add(edit);
  return before;
}

}  // namespace

void keep_first(std::size_t scans, SessionFacts& facts) {
  std::size_t left = scans;
  for (std::size_t i = 0; i < facts.logs.size(); ++i) {
    RecordedLog& log = facts.logs[i];
    const std::size_t taken = i + 1 < facts.logs.size() ? std::min(log.scans, left) : left;
    if (taken < log.scans) {
      log.broken_off.reset();
      log.scans_left = true;
    }
    log.scans = taken;
    left -= log.scans;
    if (left == 0) facts.logs.resize(i + 1);
  }
  const auto lost = std::find_if(facts.runs.begin(), facts.runs.end(),
                                 [&](const RecordedRun& run) { return run.scan >= scans; });
  if (lost == facts.runs.end()) return;
  facts.edits = edits_before(lost->scan, facts.edits);
  facts.runs.erase(lost, facts.runs.end());
}

}  // namespace psi_slam
