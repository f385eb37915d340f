// SPDX-License-Identifier: BSD-3-Clause
#include "session/superseded_scans.h"

#include <cerrno>
#include <system_error>

#include "base/byte_cursor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kScansOfPart = 256;
constexpr int kLevel = 3;

}  // namespace

void SupersededScans::add(std::size_t scan, Frame frame) {
  scans_.push_back(scan);
  waiting_.push_back(std::move(frame));
  if (waiting_.size() >= kScansOfPart) write_waiting();
}

void SupersededScans::write_waiting() {
  const std::vector<Frame> part = std::exchange(waiting_, {});
  if (failure_) return;
  if (!file_) file_.reset(std::tmpfile());
  const std::string bytes = writer_.packed("", part, kLevel);
  if (!file_ || std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size())
    failure_ = std::generic_category().message(errno);
}

void SupersededScans::put_back(std::vector<Frame>& frames) const {
  std::string bytes;
  std::optional<std::string> failure = failure_;
  if (file_ && !failure) {
    std::rewind(file_.get());
    char block[1 << 16];
    while (const std::size_t count = std::fread(block, 1, sizeof block, file_.get()))
      bytes.append(block, count);
    // The next part goes to the end.
    if (std::ferror(file_.get()) != 0 || std::fseek(file_.get(), 0, SEEK_END) != 0)
      failure = std::generic_category().message(errno);
  }
  if (failure)
    throw SystemFailure("cannot keep the scans of earlier passes in the folder for temporary files: " +
                        *failure);
  SessionRecording kept;
  SessionContentReader reader("", bytes.size());
  for (ByteCursor parts(bytes); !parts.at_end();) reader.add(parts, kept);
  kept.frames.insert(kept.frames.end(), waiting_.begin(), waiting_.end());
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const std::size_t index = frames.at(scans_[i]).index;
    frames[scans_[i]] = std::move(kept.frames[i]);
    frames[scans_[i]].index = index;
  }
}

}  // namespace psi_slam
