// SPDX-License-Identifier: BSD-3-Clause
#include "live/growing_log.h"

#include <array>
#include <chrono>
#include <fstream>
#include <string>
#include <string_view>
#include <system_error>
#include <thread>
#include <utility>

#include "base/compression/decompressor.h"
#include "base/compression/growing_file.h"
#include "base/text_parts.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::chrono::milliseconds kWait{100};
// A recorder writes its last bytes at most so long after it has closed a bag.
constexpr std::chrono::seconds kClosing{10};

class GrowingLines : public LineStream {
 public:
  GrowingLines(const fs::path& file, LiveControl control, std::optional<double> idle_s)
      : LineStream(file, std::move(control), idle_s), file_(file) {}

 protected:
  Received receive(std::string& bytes) override {
    std::array<char, kMostBytes> room{};
    const std::size_t got = file_.read(room.data(), room.size());
    if (got == 0) std::this_thread::sleep_for(kWait);
    bytes.append(room.data(), got);
    return got > 0 ? Received::kBytes : Received::kNothing;
  }

 private:
  GrowingFile file_;
};

class GrowingBytes : public ByteSource {
 public:
  GrowingBytes(const fs::path& file, BagRecorder recorder) : file_(file), recorder_(std::move(recorder)) {}

  std::size_t read(char* bytes, std::size_t size) override {
    const Clock::time_point began = Clock::now();
    std::optional<Clock::time_point> closed;
    while (!ended_) {
      ended_ = recorder_.should_stop();
      if (ended_) break;
      if (const std::size_t got = file_.read(bytes, size); got > 0) return got;
      const Clock::time_point now = Clock::now();
      if (!closed && recorder_.is_closed()) closed = now;
      // The recorder may have written after the first reading and before it closed the file.
      if (const std::size_t got = file_.read(bytes, size); got > 0) return got;
      const std::chrono::duration<double> waited = now - began;
      ended_ = (closed && now - *closed > kClosing) || !recorder_.wait(waited.count());
    }
    return 0;
  }

  const fs::path& path() const override { return file_.path(); }
  double progress() const override { return 0; }

 private:
  GrowingFile file_;
  BagRecorder recorder_;
  bool ended_ = false;
};

LogFormat format_by_name(fs::path file) {
  if (file.extension() == ".gz") file.replace_extension();
  const std::string ending = file.extension().string();
  if (ending == ".bag" || ending == ".active") return LogFormat::kRos1Bag;
  if (ending == ".mcap") return LogFormat::kRos2Mcap;
  if (ending == ".db3") return LogFormat::kRos2Sqlite;
  return ending == ".rawlog" ? LogFormat::kMrptRawlog : LogFormat::kCarmen;
}

/// Returns the first bytes on disk.
std::string head_of(const fs::path& file) {
  std::string head(6, '\0');
  std::ifstream stream(file, std::ios::binary);
  stream.read(head.data(), static_cast<std::streamsize>(head.size()));
  head.resize(static_cast<std::size_t>(stream.gcount()));
  return head;
}

}  // namespace

LogFormat growing_format(const fs::path& file) {
  std::error_code ignored;
  if (!fs::exists(file, ignored))
    throw UserError(file.string() + " does not exist, expected a log that is being recorded. Check the path");
  if (fs::is_directory(file, ignored)) {
    if (fs::is_empty(file, ignored) || !numbered_bag_files(file).empty()) return LogFormat::kRos2Folder;
    throw UserError(file.string() +
                    " has no .db3 or .mcap files, expected the folder of a ROS 2 bag, or a log that is being "
                    "recorded. Check the path");
  }
  // Looking at the first bytes of a pipe would take them from the stream.
  if (!fs::is_regular_file(file, ignored))
    throw UserError(file.string() +
                    " is no regular file, expected a log that is being recorded. Pipe it to "
                    "--stdin");
  const std::string head = head_of(file);
  LogFormat format = format_by_name(file);
  try {
    format = detect_log_format(file);
  } catch (const UserError&) {  // it is empty, or its first lines are comments
  }
  const std::string_view compression = compression_of(head);
  const bool is_followable =
      compression.empty() || (compression == "gzip" && format != LogFormat::kRos2Sqlite);
  if (!is_followable)
    throw UserError(
        file.string() +
        " is a compressed file and cannot be followed, expected a file that grows. Map it without "
        "--follow, or follow the folder of its bag");
  return format;
}

BagRecorder patient_recorder(LiveControl control, std::optional<double> idle_s) {
  BagRecorder recorder;
  recorder.should_stop = control.should_stop;
  recorder.notify = std::move(control.notify);
  recorder.wait = [should_stop = std::move(control.should_stop), idle_s](double waited_s) {
    if (should_stop() || (idle_s && waited_s >= *idle_s)) return false;
    std::this_thread::sleep_for(kWait);
    return true;
  };
  return recorder;
}

std::unique_ptr<LineStream> growing_lines(const fs::path& file, LiveControl control,
                                          std::optional<double> idle_s) {
  return std::make_unique<GrowingLines>(file, std::move(control), idle_s);
}

std::unique_ptr<ByteSource> growing_bytes(const fs::path& file, BagRecorder recorder) {
  return std::make_unique<GrowingBytes>(file, std::move(recorder));
}

}  // namespace psi_slam
