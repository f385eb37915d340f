// SPDX-License-Identifier: BSD-3-Clause
#include "session/superseded_scans.h"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <system_error>

#include "base/byte_cursor.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

constexpr std::size_t kScansOfPart = 256;
constexpr int kLevel = 3;

/// Opens a new file without a name in the folder for temporary files. Null if that is not possible.
std::FILE* temporary_file() {
  std::error_code failure;
  std::string name = (std::filesystem::temp_directory_path(failure) / "psi-slam-XXXXXX").string();
  if (failure) return nullptr;
  const int descriptor = mkstemp(name.data());
  if (descriptor < 0) return nullptr;
  unlink(name.c_str());
  std::FILE* const file = fdopen(descriptor, "w+b");
  if (file == nullptr) close(descriptor);
  return file;
}

}  // namespace

void SupersededScans::add(std::size_t scan, Frame frame) {
  scans_.push_back(scan);
  waiting_.push_back(std::move(frame));
  if (waiting_.size() >= kScansOfPart && !is_full_) write_waiting();
}

void SupersededScans::write_waiting() {
  if (!file_) file_.reset(temporary_file());
  const SessionContentWriter before = writer_;
  const std::string bytes = writer_.packed("", waiting_, kLevel);
  is_full_ = !file_ || std::fwrite(bytes.data(), 1, bytes.size(), file_.get()) != bytes.size() ||
             std::fflush(file_.get()) != 0;
  if (is_full_) {
    writer_ = before;
    return;
  }
  file_bytes_ += bytes.size();
  waiting_.clear();
}

void SupersededScans::put_back(std::vector<Frame>& frames) const {
  SessionRecording kept;
  try {
    std::string bytes(file_bytes_, '\0');
    if (file_) {
      std::rewind(file_.get());
      const bool is_read = std::fread(bytes.data(), 1, bytes.size(), file_.get()) == bytes.size();
      // The next part goes to the end.
      if (!is_read || std::fseek(file_.get(), 0, SEEK_END) != 0)
        throw std::system_error(errno, std::generic_category());
    }
    SessionContentReader reader("", bytes.size());
    for (ByteCursor parts(bytes); !parts.at_end();) reader.add(parts, kept);
  } catch (const std::runtime_error& error) {  // also MalformedBytes
    throw SystemFailure(std::string("cannot read the scans of earlier passes from the temporary file: ") +
                        error.what());
  }
  kept.frames.insert(kept.frames.end(), waiting_.begin(), waiting_.end());
  for (std::size_t i = 0; i < scans_.size(); ++i) {
    const std::size_t index = frames.at(scans_[i]).index;
    frames[scans_[i]] = std::move(kept.frames.at(i));
    frames[scans_[i]].index = index;
  }
}

}  // namespace psi_slam
