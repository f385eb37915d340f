// SPDX-License-Identifier: BSD-3-Clause
#include "frames/synchronized_source.h"

#include <utility>

#include "psi_slam/user_error.h"

namespace psi_slam {

SynchronizedSource::SynchronizedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

std::optional<Frame> SynchronizedSource::next() {
  while (true) {
    if (auto frame = synchronizer_.take()) {
      frame->index = frames_given_++;
      return frame;
    }
    if (at_end_) {
      if (failure_) std::rethrow_exception(std::exchange(failure_, nullptr));
      return std::nullopt;
    }
    read();
  }
}

SkippedLines SynchronizedSource::skipped_lines() const {
  SkippedLines skipped = source_->skipped_lines();
  skipped.spare_scans += synchronizer_.left_out();
  return skipped;
}

void SynchronizedSource::read() {
  try {
    if (auto scan = source_->next()) {
      synchronizer_.add(*std::move(scan));
      return;
    }
  } catch (const UserError&) {
    failure_ = std::current_exception();
  }
  at_end_ = true;
  synchronizer_.end_of_log();
}

}  // namespace psi_slam
