// SPDX-License-Identifier: BSD-3-Clause
#include "live/live_source.h"

#include <filesystem>
#include <utility>

#include "live/growing_folder.h"
#include "live/growing_log.h"
#include "live/line_streams.h"
#include "live/sensor_module.h"
#include "logs/carmen/carmen_stream.h"
#include "logs/frame_pipeline.h"
#include "logs/frames/height_slice.h"
#include "logs/rawlog/observation_stream.h"
#include "logs/rosbag/rosbag_stream.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

/// Opens the reader of a stream.
template <class Stream>
using OpenReader = std::unique_ptr<LogReader> (*)(std::unique_ptr<Stream>, const LogOptions&, double);

/// Frames of a reader that is opened by the first call of next(), because that waits for the first scans. If
/// that fails, there are no frames.
template <class Stream>
class AwaitedSource : public FrameSource {
 public:
  AwaitedSource(std::unique_ptr<Stream> stream, OpenReader<Stream> open, LogFormat format, LogOptions options,
                double look_over_s)
      : stream_(std::move(stream)),
        open_(open),
        format_(format),
        options_(std::move(options)),
        look_over_s_(look_over_s) {}

  std::optional<Frame> next() override {
    if (stream_)
      source_ =
          frames_to_map(open_(std::move(stream_), options_, look_over_s_), format_, options_, look_over_s_);
    return source_ ? source_->next() : std::nullopt;
  }
  double progress() const override { return 0; }
  SkippedLines skipped_lines() const override { return source_ ? source_->skipped_lines() : SkippedLines(); }
  std::vector<std::string> assumptions() const override {
    return source_ ? source_->assumptions() : std::vector<std::string>();
  }

 private:
  std::unique_ptr<Stream> stream_;  // null after it was opened
  OpenReader<Stream> open_;
  LogFormat format_;
  LogOptions options_;
  double look_over_s_;
  std::unique_ptr<FrameSource> source_;
};

LogFormat format_of(const LiveInput& input) {
  if (input.kind == LiveInput::Kind::kFollow) return growing_format(input.file);
  if (input.kind == LiveInput::Kind::kRos2) return LogFormat::kRos2Folder;
  return input.kind == LiveInput::Kind::kSensors ? LogFormat::kMrptRawlog : LogFormat::kCarmen;
}

std::unique_ptr<BagRecording> follow_messages(const LiveInput& input, LogFormat format,
                                              const LiveControl& control) {
  const std::filesystem::path path = input.file;
  BagRecorder recorder = patient_recorder(control, input.idle_s);
  if (format == LogFormat::kRos2Folder)
    return std::make_unique<BagRecording>(
        BagRecording{path, std::make_unique<GrowingFolder>(path, std::move(recorder)), {}});
  recorder.is_closed = [path] { return is_closed_bag(path.parent_path(), path); };
  return std::make_unique<BagRecording>(BagRecording{path, follow_sqlite_bag(path, std::move(recorder)), {}});
}

std::unique_ptr<BagRecording> receive_messages(const LiveInput& input, const LogOptions& options,
                                               const LiveControl& control) {
  const auto link = input.ros2_link ? input.ros2_link : open_ros2_link(input.ros2);
  const Ros2Reading reading{height_slice(options).has_value(), input.record, input.replaces_record,
                            input.idle_s};
  return std::make_unique<BagRecording>(BagRecording{name_of(input), link->messages(reading, control),
                                                     [link](const BagPlan& plan) { link->set_plan(plan); }});
}

std::unique_ptr<LineStream> open_lines(const LiveInput& input, const LiveControl& control) {
  if (input.kind == LiveInput::Kind::kTcp) return tcp_input(input.address, input.port, control, input.idle_s);
  if (input.kind == LiveInput::Kind::kFollow) return growing_lines(input.file, control, input.idle_s);
  return standard_input(control, input.idle_s);
}

}  // namespace

std::string name_of(const LiveInput& input) {
  switch (input.kind) {
    case LiveInput::Kind::kStandardInput:
      return "standard input";
    case LiveInput::Kind::kTcp:
      return "TCP port " + std::to_string(input.port);
    case LiveInput::Kind::kRos2:
      return "ROS 2";
    case LiveInput::Kind::kFollow:
    case LiveInput::Kind::kSensors:
      break;
  }
  const std::filesystem::path path(input.file);
  return (path.has_filename() ? path : path.parent_path()).filename().string();
}

std::unique_ptr<FrameSource> open_live(const LiveInput& input, const LogOptions& options,
                                       const LiveControl& control) {
  check_log_options(options);
  const std::string name = name_of(input);
  if (options.calibrate)
    throw UserError("log.calibrate needs a complete log, but " + name +
                    " is still being sent. Calibrate a recorded log, and set the options that it reports");
  const LogFormat format = format_of(input);
  check_options_for(format, name, options);
  if (input.kind == LiveInput::Kind::kSensors)
    return std::make_unique<AwaitedSource<ObjectSource>>(open_sensors(input.file, control, input.idle_s),
                                                         open_observation_stream, format, options,
                                                         input.look_over_s);
  if (input.kind == LiveInput::Kind::kRos2)
    return std::make_unique<AwaitedSource<BagRecording>>(
        receive_messages(input, options, control), open_followed_bag, format, options, input.look_over_s);
  if (format == LogFormat::kCarmen)
    return std::make_unique<AwaitedSource<ByteSource>>(open_lines(input, control), open_carmen_stream, format,
                                                       options, input.look_over_s);
  if (format == LogFormat::kRos2Sqlite || format == LogFormat::kRos2Folder)
    return std::make_unique<AwaitedSource<BagRecording>>(
        follow_messages(input, format, control), open_followed_bag, format, options, input.look_over_s);
  return std::make_unique<AwaitedSource<ByteSource>>(
      growing_bytes(input.file, patient_recorder(control, input.idle_s)),
      format == LogFormat::kMrptRawlog ? open_rawlog_stream : open_rosbag_stream, format, options,
      input.look_over_s);
}

}  // namespace psi_slam
