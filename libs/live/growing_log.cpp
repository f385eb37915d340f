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

#include "base/text_parts.h"
#include "compression/compression.h"
#include "compression/growing_file.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

constexpr std::size_t kMostBytes = std::size_t{64} * 1024;  // bytes received at once
constexpr std::chrono::milliseconds kWait{100};

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
  GrowingBytes(const fs::path& file, LiveControl control, std::optional<double> idle_s)
      : file_(file), control_(std::move(control)), idle_s_(idle_s) {}

  std::size_t read(char* bytes, std::size_t size) override {
    const Clock::time_point began = Clock::now();
    while (!ended_ && !control_.should_stop()) {
      if (const std::size_t got = file_.read(bytes, size); got > 0) return got;
      if (idle_s_ && std::chrono::duration<double>(Clock::now() - began).count() >= *idle_s_) break;
      std::this_thread::sleep_for(kWait);
    }
    ended_ = true;
    return 0;
  }

  const fs::path& path() const override { return file_.path(); }
  double progress() const override { return 0; }

 private:
  GrowingFile file_;
  LiveControl control_;
  std::optional<double> idle_s_;
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
  std::string head(4, '\0');
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
  const std::string remedy =
      " cannot be followed, expected a CARMEN log, a rawlog, a ROS 1 bag or an MCAP file. Record one of "
      "these, or map the log when it is complete";
  if (fs::is_directory(file, ignored)) throw UserError(file.string() + " is a folder and" + remedy);
  // Looking at the first bytes of a pipe would take them from the stream.
  if (!fs::is_regular_file(file, ignored))
    throw UserError(file.string() +
                    " is no regular file, expected a log that is being recorded. Pipe it to "
                    "--stdin");
  if (is_zstd(head_of(file))) throw UserError(file.string() + " is compressed by zstd and" + remedy);
  LogFormat format = format_by_name(file);
  try {
    format = detect_log_format(file);
  } catch (const UserError&) {  // it is empty, or its first lines are comments
  }
  if (format == LogFormat::kRos2Sqlite)
    throw UserError(file.string() + " is a " + std::string(name_of(format)) + " and" + remedy);
  return format;
}

std::unique_ptr<LineStream> growing_lines(const fs::path& file, LiveControl control,
                                          std::optional<double> idle_s) {
  return std::make_unique<GrowingLines>(file, std::move(control), idle_s);
}

std::unique_ptr<ByteSource> growing_bytes(const fs::path& file, LiveControl control,
                                          std::optional<double> idle_s) {
  return std::make_unique<GrowingBytes>(file, std::move(control), idle_s);
}

}  // namespace psi_slam
