// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_tail.h"

#include <unistd.h>

#include <cerrno>
#include <utility>

#include "base/partial_files.h"

namespace psi_slam {

FileTail::FileTail(std::filesystem::path path, Descriptor file, std::size_t written_bytes)
    : path_(std::move(path)), file_(std::move(file)), written_bytes_(written_bytes) {}

void FileTail::write() {
  for (std::size_t done = 0; done < unwritten_.size();) {
    const ssize_t count = ::pwrite(file_.number(), unwritten_.data() + done, unwritten_.size() - done,
                                   static_cast<off_t>(written_bytes_ + done));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) throw cannot_write(path_, count < 0 ? errno : ENOSPC);
    done += static_cast<std::size_t>(count);
  }
  if (::fdatasync(file_.number()) != 0 && errno != EINVAL) throw cannot_write(path_, errno);
  written_bytes_ += unwritten_.size();
  unwritten_ = {};
}

}  // namespace psi_slam
