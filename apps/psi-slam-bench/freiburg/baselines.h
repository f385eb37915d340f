// SPDX-License-Identifier: BSD-3-Clause
// Baselines: MRPT's icp-slam and rbpf-slam, if they are installed. Runs them on the logs of the benchmark and
// evaluates their paths like those of psi-slam. A baseline gets every scan that psi-slam reads, the odometry
// between the scans and the mount of the laser.
#pragma once

#include <atomic>
#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "batch/run_figures.h"
#include "batch/workers.h"
#include "common/benchmark_logs.h"
#include "psi_slam/time_stamp.h"

namespace psi_slam {

/// Properties of a baseline, installed or not.
struct BaselineKind {
  std::string name;    ///< name of the program: "icp-slam"
  std::string config;  ///< path of the shipped settings, relative to share/mrpt/config_files
  /// Changed settings of the section MappingApplication: no windows, no pictures, a fixed random seed.
  std::vector<std::pair<std::string, std::string>> changes;
  std::string remark;          ///< remark on the figures of the baseline; may be empty
  std::size_t yaw_column = 3;  ///< column of the yaw in the path file, counted from 0
};
const std::vector<BaselineKind>& baseline_kinds();

struct BaselineProgram {
  BaselineKind kind;
  std::filesystem::path program;
  std::filesystem::path config;
  std::string version;  ///< as the program prints it: "MRPT 2.5.8 - Sources timestamp: ..."
  std::string sha256;   ///< checksum of the program file
};

struct FoundBaselines {
  std::vector<BaselineProgram> programs;
  std::vector<std::string> missing;  ///< a sentence with the reason for each program that cannot be run
};

/// Finds the programs in the folders of `search_path`, separated by colons as in PATH, and their settings in
/// the folder share/ beside the bin/ of each program.
FoundBaselines find_baselines(const std::string& search_path);

/// Text of the shipped settings, with BaselineKind::changes and with the folder for the program's output.
/// Throws UserError when the shipped settings cannot be read.
std::string baseline_settings(const BaselineProgram& baseline, const std::filesystem::path& output);

/// The settings that the benchmark changes, as text: "SAVE_3D_SCENE = 0, RANDOM_SEED = 1".
std::string changes_text(const BaselineKind& kind);

struct BaselineRun {
  BaselineProgram baseline;
  BenchmarkLog log;              ///< log that has relations
  std::filesystem::path folder;  ///< folder for the input and the output of the baseline
  double time_limit_s = 0;
};

struct BaselineResult {
  std::string log;
  std::string baseline;  ///< name of the baseline: "icp-slam"
  std::optional<RunFigures> figures;
  std::optional<double> not_finished_in_s;  ///< the time limit that ended the run
  std::string failure;                      ///< any other reason for missing figures
  bool made = false;  ///< true: the run was made now; false: its result was kept from before
};

/// Runs the baseline until it ends, exceeds its time limit or `stop` returns true. An error or an interrupt
/// is returned as BaselineResult::failure. Settings and output stay in the folder. Throws SystemFailure when
/// the folder cannot be written.
BaselineResult run_baseline(const BaselineRun& run, const std::function<bool()>& stop);

/// Writes all frames as a rawlog of actions and sensory frames, which MRPT's programs read: the motion since
/// the previous frame by odometry, then the scan with its beams and the mount of its laser. The motion is
/// zero for the first frame and for frames without odometry. The noise of odometry is MRPT's default. Returns
/// the times of the frames. Calls `stop` for each frame. Throws SystemFailure when `stop` returns true or the
/// file cannot be written. Passes on exceptions of the source.
std::vector<TimeUs> write_baseline_log(FrameSource& source, const std::filesystem::path& path,
                                       const std::function<bool()>& stop);

/// Reads a path from lines "step x y ... yaw ...", one for each of the times. Steps count from 0; lengths are
/// in metres, and angles in radians. Throws UserError for a missing file or lines of another form or number.
Trajectory read_baseline_path(const std::filesystem::path& file, std::size_t yaw_column,
                              const std::vector<TimeUs>& times);

struct BaselineOptions {
  double time_limit_s = 600;     ///< time limit of each run
  int processes = 1;             ///< number of runs at a time
  std::filesystem::path output;  ///< folder for runs/LOG-BASELINE.json and for the files of the runs
};

/// Runs every baseline on every log, each run in a process of its own. Does not repeat a run while the log,
/// its relations and settings, the baseline and its settings, the machine and the version of psi-slam stay
/// the same. A run that did not finish is repeated only with a larger time limit. The results are ordered by
/// log, then baseline. All `logs` need relations. When `stop` becomes true, ends the running processes and
/// throws SystemFailure. Also throws SystemFailure when a file cannot be written.
std::vector<BaselineResult> run_baselines(const std::vector<BaselineProgram>& baselines,
                                          const std::vector<BenchmarkLog>& logs,
                                          const BaselineOptions& options, const std::atomic<bool>& stop,
                                          const ProgressObserver& observer);

}  // namespace psi_slam
