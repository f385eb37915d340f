// SPDX-License-Identifier: BSD-3-Clause
// The report of a benchmark as Markdown, JSON, CSV and plots, and the sections that all reports share.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "batch/report_table.h"
#include "common/benchmark_logs.h"

namespace psi_slam {

struct BenchReport {
  std::string page;      ///< file name of the Markdown page: "robustness.md"
  std::string markdown;  ///< text of the Markdown page
  std::string json;
  std::string csv;  ///< main table of the report as CSV

  struct Plot {
    std::string file;     ///< file name: "robustness-scans-kept.svg"
    std::string content;  ///< bytes of the file
  };
  std::vector<Plot> plots;
};

/// Commit that the program was built from: "bf09480d1c2e", followed by " and changes" if tracked files
/// differed from it; "unknown" for a build outside a git clone.
std::string program_commit();

/// Names version, commit and machine: "psi-slam 0.1.0, commit bf09480d1c2e, AMD EPYC, 2 processors".
std::string measured_by(const std::string& machine);

/// A report's JSON: schema, program and machine, then `members`.
nlohmann::ordered_json report_json(const std::string& schema, const std::string& machine,
                                   const nlohmann::ordered_json& members);

struct LogIdentity {
  std::string name;
  std::string sha256;            ///< checksum of the log file
  std::string relations_sha256;  ///< checksum of the file with the log's relations
};

/// Checksums of logs and of their relations. All logs must have relations. Throws UserError when a file
/// cannot be read.
std::vector<LogIdentity> identities_of(const std::vector<BenchmarkLog>& logs);

ReportTable logs_table(const std::vector<LogIdentity>& logs);

/// Section with the checksums of the logs. It also lists the logs that were left out because they have no
/// relations.
std::string logs_section(const std::vector<LogIdentity>& logs,
                         const std::vector<std::string>& without_relations);

}  // namespace psi_slam
