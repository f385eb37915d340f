// SPDX-License-Identifier: BSD-3-Clause
// What a mapping session tells about its logs.
#include <algorithm>
#include <utility>

#include "logs/frames/log_reader.h"
#include "map/exports/frozen_odometry.h"
#include "map/exports/interruptions.h"
#include "map/exports/run_summary.h"
#include "map/exports/unmatched_scans.h"
#include "psi_slam/version.h"
#include "session/mapping_session_members.h"
#include "session/session_input.h"
#include "session/work_clock.h"

namespace psi_slam {

SkippedLines MappingSession::skipped_lines() const {
  SkippedLines skipped;
  for (auto before = m_->logs.begin(); before != m_->logs.end() - 1; ++before)
    skipped = skipped + before->skipped;
  return skipped + m_->source->skipped_lines();
}

const std::optional<std::string>& MappingSession::broken_off() const {
  return m_->broken_off;
}

bool MappingSession::breaks_off() const {
  return m_->broken_off || std::any_of(m_->logs.begin(), m_->logs.end() - 1, [](const RecordedLog& before) {
           return before.broken_off.has_value();
         });
}

std::vector<std::string> MappingSession::warnings_of_logs_before() const {
  std::vector<std::string> warnings;
  for (auto log = m_->logs.begin(); log != m_->logs.end() - 1; ++log) {
    if (log->broken_off)
      warnings.push_back(*log->broken_off + "; this run is mapped up to the damage");
    else if (log->scans_left)
      warnings.push_back("only the first " + std::to_string(log->scans) + " scans of " + log->name +
                         " are mapped: the run was interrupted and never resumed");
  }
  return warnings;
}

std::vector<std::string> MappingSession::unmet_edits() const {
  std::vector<std::string> unmet = m_->edit_complaints;
  unmet.insert(unmet.end(), m_->result.unmet_edits.begin(), m_->result.unmet_edits.end());
  unmet.insert(unmet.end(), m_->map_edit_complaints.begin(), m_->map_edit_complaints.end());
  return unmet;
}

std::vector<std::string> MappingSession::assumptions() const {
  std::vector<std::string> assumptions = m_->source->assumptions();
  for (const RecordedLog& log : m_->logs) {
    const std::string of_log = m_->logs.size() > 1 ? log.name + ": " : "";
    if (&log != &m_->logs.back())  // those of the last log are the first
      for (const std::string& sentence : log.assumptions) assumptions.push_back(of_log + sentence);
    if (!log.calibration) continue;
    for (const std::string& sentence : log.calibration->sentences) assumptions.push_back(of_log + sentence);
  }
  const std::vector<Frame>& log = m_->mapped_log();
  const auto without = static_cast<std::size_t>(
      std::count_if(log.begin(), log.end(), [](const Frame& frame) { return !frame.has_odometry; }));
  const bool has_gyroscope = std::any_of(
      log.begin(), log.end(), [](const Frame& frame) { return frame.imu_heading_rad.has_value(); });
  if (without == log.size() && without > 0 && !ignores_odometry(log_options(m_->settings)))
    assumptions.push_back(
        std::string("the log has no odometry, so the motion between scans follows from the scans ") +
        (has_gyroscope ? "and the gyroscope" : "alone"));
  else if (without > 0 && without < log.size())
    assumptions.push_back(std::to_string(without) + " of " + std::to_string(log.size()) +
                          " scans have no odometry");
  return assumptions;
}

const std::vector<std::string>& MappingSession::faults_of_log() const {
  const WorkClock clock(m_->work_s);
  std::vector<Frame> room;
  std::vector<std::string> complaints;  // those of an export name an unreadable file
  if (m_->is_unchecked()) m_->check_log(m_->whole_log(room, complaints));
  return m_->faults;
}

std::vector<std::string> MappingSession::warnings() const {
  std::vector<std::string> warnings = m_->settings_warnings;
  for (const std::string& warning : warnings_of_logs_before()) warnings.push_back(warning);
  if (m_->broken_off) warnings.push_back(*m_->broken_off);
  if (const SkippedLines skipped = skipped_lines(); skipped.count > 0) warnings.push_back(skipped.sentence());
  for (const std::string& assumption : assumptions()) warnings.push_back(assumption);
  for (const std::string& fault : faults_of_log()) warnings.push_back(fault);
  for (const std::string& complaint : unmet_edits()) warnings.push_back("an edit was not made: " + complaint);
  for (const std::string& sentence : m_->result.contradictions) warnings.push_back(sentence);
  const MapVerdict* verdict = m_->verdict ? &*m_->verdict : nullptr;
  if (const auto unmatched = unmatched_scans_text(m_->result, verdict)) warnings.push_back(*unmatched);
  if (const auto frozen = frozen_odometry_text(m_->result)) warnings.push_back(*frozen);
  for (const std::string& interruption : interruption_texts(m_->result)) warnings.push_back(interruption);
  return warnings;
}

RunInfo MappingSession::run_info() const {
  BoundSettings bound;
  bound.settings = m_->settings;
  RunInfo info{PSI_SLAM_VERSION, names_of(m_->logs), {}, {}};
  for (const OptionSection& section : bound.table.sections())
    for (const Option& option : section.options) info.settings[option.name()] = option.text();
  for (const auto& [name, constant] : bound.table.constants())
    if (constant.text() != constant.default_text) info.settings[name] = constant.text();
  info.warnings = warnings();
  for (const RecordedLog& log : m_->logs) {
    if (!log.calibration) continue;
    const std::vector<CalibratedOption>& estimates = log.calibration->estimates;
    info.calibration.insert(info.calibration.end(), estimates.begin(), estimates.end());
  }
  return info;
}

}  // namespace psi_slam
