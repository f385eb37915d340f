// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulated_log_file.h"

#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "common/bench_command.h"
#include "compression/compression.h"
#include "exports/corrected_log.h"
#include "psi_slam/user_error.h"
#include "simulate/simulate_benchmark.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

constexpr const char* kEnding = ".clf.gz";

/// A file that the destructor deletes.
struct ScratchFile {
  fs::path path;

  explicit ScratchFile(fs::path file) : path(std::move(file)) {}
  ScratchFile(const ScratchFile&) = delete;
  ScratchFile& operator=(const ScratchFile&) = delete;
  ~ScratchFile() {
    std::error_code ignored;
    fs::remove(path, ignored);
  }
};

/// The file beside `log` with another ending.
fs::path beside(const fs::path& log, const std::string& ending) {
  const std::string name = log.filename().string();
  return log.parent_path() / (name.substr(0, name.size() - std::string(kEnding).size()) + ending);
}

std::string relations_text(const std::vector<Relation>& relations) {
  std::string text;
  for (const Relation& relation : relations) {
    const mrpt::math::TPose2D& pose = relation.pose1_T_pose2;
    text += format_seconds(relation.time1_us) + ' ' + format_seconds(relation.time2_us) + ' ' +
            fixed_text(pose.x, 6) + ' ' + fixed_text(pose.y, 6) + " 0 0 0 " + fixed_text(pose.phi, 6) + '\n';
  }
  return text;
}

}  // namespace

void check_simulated_log_file(const fs::path& log) {
  const std::string name = log.filename().string();
  const std::string ending = kEnding;
  if (name.size() <= ending.size() || name.compare(name.size() - ending.size(), ending.size(), ending) != 0)
    throw UserError(log.string() + " cannot be a log file: choose a name that ends in " + ending);
  check_writable(log);
}

void write_simulated_log(const fs::path& log, const SimulatedLogOptions& run) {
  SimulatedLog simulated(run);
  std::vector<Frame> frames;
  std::vector<mrpt::math::TPose2D> poses;
  Trajectory truth;
  while (std::optional<Frame> frame = simulated.next()) {
    poses.push_back(simulated.world_T_robot());
    truth.push_back({frame->time_us, simulated.world_T_robot()});
    frames.push_back(*std::move(frame));
  }
  const ScratchFile plain(log.string() + ".plain");
  write_corrected_log(plain.path, frames, poses);
  std::ifstream file(plain.path, std::ios::binary);
  const std::string text(std::istreambuf_iterator<char>(file), {});
  write_text_atomically(log, gzipped(text.data(), text.size()));
  write_text_atomically(beside(log, ".relations"),
                        relations_text(draw_relations(truth, kRelations, run.path.seed)));
  write_tum(beside(log, ".tum"), truth);
}

}  // namespace psi_slam
