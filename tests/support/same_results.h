// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "test_files.h"

namespace psi_slam {

/// Rows of a CSV text without their last `columns` columns.
inline std::string without_last_columns(const std::string& csv, int columns) {
  std::istringstream rows(csv);
  std::string text;
  for (std::string row; std::getline(rows, row); text += row + '\n')
    for (int i = 0; i < columns; ++i) row.resize(std::min(row.size(), row.rfind(',')));
  return text;
}

/// Rows of frames.csv without the columns of times, whose names end in "_ms".
inline std::string without_times_of_frames(const std::string& csv) {
  std::istringstream rows(csv);
  std::vector<bool> is_time;
  std::string text;
  for (std::string row; std::getline(rows, row); text += '\n') {
    std::istringstream fields(row);
    std::size_t column = 0;
    for (std::string field; std::getline(fields, field, ','); ++column) {
      if (text.empty() || is_time.size() <= column)
        is_time.push_back(field.size() > 3 && field.substr(field.size() - 3) == "_ms");
      if (!is_time[column]) text += field + ',';
    }
  }
  return text;
}

/// summary.json without the entries in which equal runs can differ: times, memory, threads and log name.
inline std::string summary_without_times(const std::string& text) {
  nlohmann::json summary = nlohmann::json::parse(text);
  for (const char* key : {"wall_s", "real_time_factor", "peak_memory_mib", "stages"}) summary.erase(key);
  for (nlohmann::json& matcher : summary.at("loop_matchers")) {
    matcher.erase("milliseconds");
    matcher.at("last_pass").erase("milliseconds");
    for (nlohmann::json& search : matcher.at("searches")) search.erase("milliseconds");
  }
  summary.at("settings").erase("run.threads");
  summary.at("log").erase("name");
  return summary.dump(1);
}

/// Three cards of report.html and the table of facts about the log. Leaves out times, settings and log name.
inline std::string report_without_times(const std::string& html) {
  const std::string begin = "<section class=\"card\"><h2>";
  std::string text;
  for (std::size_t at = html.find(begin); at != std::string::npos; at = html.find(begin, at + 1)) {
    const std::string card = html.substr(at, html.find("</section>", at) - at);
    for (const char* title : {"Map", "Response of the front end", "The factor Ψ and the searches that ran"})
      if (card.rfind(begin + title, 0) == 0) text += card;
  }
  const std::string log = "<tr><th>Scans</th>";
  const std::size_t facts = html.find(log);
  if (facts != std::string::npos) text += html.substr(facts, html.find("</table>", facts) - facts);
  return text;
}

/// The contents of a result file that must be equal in equal runs. Leaves out entries that may differ, such
/// as times.
inline std::string comparable(const std::filesystem::path& file) {
  constexpr int kTimesOfLoops = 2;  // and the search, which is the last column
  const std::string bytes = read_file(file);
  if (file.filename() == "frames.csv") return without_times_of_frames(bytes);
  if (file.filename() == "loops.csv") return without_last_columns(bytes, kTimesOfLoops);
  if (file.filename() == "summary.json") return summary_without_times(bytes);
  if (file.filename() == "report.html") return report_without_times(bytes);
  return bytes;
}

inline std::set<std::string> names_of_files(const std::filesystem::path& folder) {
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder))
    names.insert(entry.path().filename().string());
  return names;
}

/// Names of the files that only one of two result folders has, or whose `comparable` contents differ.
inline std::set<std::string> differing_files(const std::filesystem::path& a, const std::filesystem::path& b) {
  std::set<std::string> names = names_of_files(a);
  names.merge(names_of_files(b));
  std::set<std::string> differing;
  for (const std::string& name : names) {
    const bool in_both = std::filesystem::exists(a / name) && std::filesystem::exists(b / name);
    if (!in_both || comparable(a / name) != comparable(b / name)) differing.insert(name);
  }
  return differing;
}

/// Expects that the result folders of two runs hold the same files with the same `comparable` contents.
inline void expect_same_results(const std::filesystem::path& a, const std::filesystem::path& b) {
  EXPECT_EQ(differing_files(a, b), std::set<std::string>()) << a << " and " << b;
  for (const char* name : {"trajectory.tum", "graph.g2o", "frames.csv", "summary.json", "report.html"})
    EXPECT_FALSE(comparable(a / name).empty()) << name;
}

}  // namespace psi_slam
