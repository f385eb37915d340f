// SPDX-License-Identifier: BSD-3-Clause
#include "live/growing_folder.h"

#include <algorithm>
#include <chrono>
#include <fstream>
#include <iterator>
#include <utility>

#include "live/growing_log.h"
#include "logs/frames/log_format.h"
#include "logs/rosbag/rosbag_stream.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

namespace fs = std::filesystem;

bool is_closed_bag(const fs::path& folder, const fs::path& file) {
  std::ifstream metadata(folder / "metadata.yaml");
  const std::string text{std::istreambuf_iterator<char>(metadata), {}};
  const std::size_t list = text.find("relative_file_paths:");  // missing while the recorder writes it
  return list != std::string::npos && text.find(file.filename().string(), list) != std::string::npos;
}

GrowingFolder::GrowingFolder(fs::path folder, BagRecorder recorder) : folder_(std::move(folder)) {
  recorder_.should_stop = [this, should_stop = std::move(recorder.should_stop)] {
    ended_ = ended_ || should_stop();
    return ended_;
  };
  recorder_.wait = [this, wait = std::move(recorder.wait)](double waited_s) {
    ended_ = ended_ || !wait(waited_s);
    return !ended_;
  };
  recorder_.is_closed = [this] { return next_file().has_value() || is_closed_bag(folder_); };
  recorder_.notify = std::move(recorder.notify);
}

void GrowingFolder::want(const std::vector<std::string>& topics) {
  BagFile::want(topics);
  if (file_) file_->want(topics);
}

bool GrowingFolder::next(BagMessage& message) {
  while (!recorder_.should_stop()) {
    if (!file_ && !open_next()) return false;
    if (file_->next(message)) return true;
    file_.reset();
  }
  return false;
}

/// Returns the first file after the last one that was opened. The user may delete files that were read.
std::optional<fs::path> GrowingFolder::next_file() const {
  const std::vector<fs::path> files = numbered_bag_files(folder_);
  const auto next = std::upper_bound(files.begin(), files.end(), last_, is_earlier_bag_file);
  return next == files.end() ? std::nullopt : std::optional(*next);
}

/// Waits for the next file and opens it. Returns false if no file will follow.
bool GrowingFolder::open_next() {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  while (!file_) {
    const bool is_closed = is_closed_bag(folder_);
    if (const std::optional<fs::path> file = next_file()) {
      const fs::path before = std::exchange(last_, *file);
      try {
        file_ = open(*file);
      } catch (const UserError&) {
        std::error_code ignored;
        if (fs::exists(*file, ignored)) throw;
        last_ = before;  // the recorder has just compressed the file
      }
    } else if (is_closed) {
      return false;
    }
    const std::chrono::duration<double> waited = Clock::now() - began;
    if (!file_ && !recorder_.wait(waited.count())) return false;
  }
  return true;
}

/// Opens a file. Returns null for an MCAP file without any bytes, which will get none.
std::unique_ptr<BagFile> GrowingFolder::open(const fs::path& file) {
  std::unique_ptr<BagFile> bag;
  if (without_zstd(file) != file) {
    bag = open_bag(file);
  } else if (file.extension() == ".db3") {
    bag = follow_sqlite_bag(file, recorder_);
  } else {
    bag = follow_record_bag(growing_bytes(file, recorder_));
  }
  if (bag) bag->want(wanted());
  return bag;
}

}  // namespace psi_slam
