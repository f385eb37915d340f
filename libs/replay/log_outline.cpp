// SPDX-License-Identifier: BSD-3-Clause
#include "replay/log_outline.h"

#include <exception>
#include <optional>
#include <utility>

#include "replay/background_thread.h"

namespace psi_slam {

LogOutline::LogOutline(const SessionInput& log, const LogOptions& options)
    : thread_([this, log, options] { read(log, options); }) {}

LogOutline::~LogOutline() {
  stop();
  thread_.join();
}

std::shared_ptr<const std::vector<TimeUs>> LogOutline::stamps_us() const {
  const std::lock_guard lock(mutex_);
  return stamps_us_;
}

void LogOutline::read(const SessionInput& log, const LogOptions& options) {
  lower_thread_priority();
  auto stamps_us = std::make_shared<std::vector<TimeUs>>();
  try {
    const auto source = log.open(options);
    for (std::optional<Frame> frame; !stop_ && (frame = source->next());)
      stamps_us->push_back(frame->time_us);
  } catch (const std::exception&) {  // the mapping reports the same error
  }
  {
    const std::lock_guard lock(mutex_);
    stamps_us_ = std::move(stamps_us);
  }
  ended_ = true;
}

}  // namespace psi_slam
