// SPDX-License-Identifier: BSD-3-Clause
#include "simulate/simulated_log_file.h"

#include <zlib.h>

#include <array>
#include <fstream>
#include <memory>
#include <string>
#include <system_error>
#include <utility>

#include "base/atomic_file.h"
#include "base/number_text.h"
#include "common/bench_command.h"
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

void compress(const fs::path& plain, const fs::path& gzipped) {
  const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(::gzopen(gzipped.c_str(), "wb6"), ::gzclose);
  std::ifstream source(plain, std::ios::binary);
  std::array<char, 1 << 16> buffer{};
  bool failed = !file || !source;
  while (!failed && source) {
    source.read(buffer.data(), buffer.size());
    const auto count = static_cast<unsigned>(source.gcount());
    failed = count > 0 && ::gzwrite(file.get(), buffer.data(), count) != static_cast<int>(count);
  }
  if (failed || ::gzflush(file.get(), Z_FINISH) != Z_OK)
    throw SystemFailure("cannot write " + gzipped.string());
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
  write_atomically(log, [&](const fs::path& temporary) {
    const ScratchFile plain(temporary.string() + ".plain");
    write_corrected_log(plain.path, frames, poses);
    compress(plain.path, temporary);
  });
  write_text_atomically(beside(log, ".relations"),
                        relations_text(draw_relations(truth, kRelations, run.path.seed)));
  write_tum(beside(log, ".tum"), truth);
}

}  // namespace psi_slam
