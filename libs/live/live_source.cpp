// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_source.h"

#include <filesystem>
#include <functional>
#include <utility>

#include "carmen/carmen_stream.h"
#include "live/line_streams.h"
#include "live/sensor_set.h"
#include "logs/frame_pipeline.h"
#include "psi_slam/user_error.h"
#include "rawlog/observation_stream.h"

namespace psi_slam {
namespace {

using OpenReader = std::function<std::unique_ptr<LogReader>()>;

/// Frames of a reader that is opened by the first call of next(), because that waits for the first scans.
class AwaitedSource : public FrameSource {
 public:
  AwaitedSource(OpenReader open, LogFormat format, LogOptions options, double look_over_s)
      : open_(std::move(open)), format_(format), options_(std::move(options)), look_over_s_(look_over_s) {}

  std::optional<Frame> next() override {
    if (!source_) source_ = frames_to_map(open_(), format_, options_, look_over_s_);
    return source_->next();
  }
  double progress() const override { return 0; }
  SkippedLines skipped_lines() const override { return source_ ? source_->skipped_lines() : SkippedLines(); }
  std::vector<std::string> assumptions() const override {
    return source_ ? source_->assumptions() : std::vector<std::string>();
  }

 private:
  OpenReader open_;
  LogFormat format_;
  LogOptions options_;
  double look_over_s_;
  std::unique_ptr<FrameSource> source_;
};

std::unique_ptr<LineStream> open_lines(const LiveInput& input, const LiveControl& control) {
  if (input.kind == LiveInput::Kind::kTcp) return tcp_input(input.address, input.port, control, input.idle_s);
  if (input.kind == LiveInput::Kind::kFollow) return growing_file(input.file, control, input.idle_s);
  return standard_input(control, input.idle_s);
}

}  // namespace

std::string name_of(const LiveInput& input) {
  switch (input.kind) {
    case LiveInput::Kind::kStandardInput:
      return "standard input";
    case LiveInput::Kind::kTcp:
      return "TCP port " + std::to_string(input.port);
    case LiveInput::Kind::kFollow:
    case LiveInput::Kind::kSensors:
      break;
  }
  return std::filesystem::path(input.file).filename().string();
}

std::unique_ptr<FrameSource> open_live(const LiveInput& input, const LogOptions& options,
                                       const LiveControl& control) {
  check_log_options(options);
  const std::string name = name_of(input);
  if (options.calibrate)
    throw UserError("log.calibrate needs a complete log, but " + name +
                    " is still being sent. Calibrate a recorded log, and set the options that it reports");
  const LogFormat format =
      input.kind == LiveInput::Kind::kSensors ? LogFormat::kMrptRawlog : LogFormat::kCarmen;
  check_options_for(format, name, options);
  // A reader is opened once, so it may take its stream.
  if (input.kind == LiveInput::Kind::kSensors) {
    auto sensors = std::make_shared<std::unique_ptr<ObjectSource>>(
        std::make_unique<SensorSet>(input.file, control, input.idle_s));
    return std::make_unique<AwaitedSource>(
        [sensors, options, look_over_s = input.look_over_s] {
          return open_observation_stream(std::move(*sensors), options, look_over_s);
        },
        format, options, input.look_over_s);
  }
  auto lines = std::make_shared<std::unique_ptr<ByteSource>>(open_lines(input, control));
  return std::make_unique<AwaitedSource>(
      [lines, options, look_over_s = input.look_over_s] {
        return open_carmen_stream(std::move(*lines), options, look_over_s);
      },
      format, options, input.look_over_s);
}

}  // namespace psi_slam
