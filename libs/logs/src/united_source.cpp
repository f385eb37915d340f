// SPDX-License-Identifier: BSD-3-Clause
#include "psi_slam/logs/united_source.h"

#include <utility>

#include "psi_slam/base/user_error.h"

namespace psi_slam {

UnitedSource::UnitedSource(std::unique_ptr<FrameSource> source) : source_(std::move(source)) {}

std::optional<Frame> UnitedSource::next() {
  while (true) {
    if (auto frame = uniter_.take()) {
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

SkippedLines UnitedSource::skipped_lines() const {
  SkippedLines skipped = source_->skipped_lines();
  skipped.spare_scans += uniter_.left_out();
  return skipped;
}

void UnitedSource::read() {
  try {
    if (auto scan = source_->next()) {
      uniter_.add(*std::move(scan));
      return;
    }
  } catch (const UserError&) {
    failure_ = std::current_exception();
  }
  at_end_ = true;
  uniter_.end_of_log();
}

}  // namespace psi_slam
