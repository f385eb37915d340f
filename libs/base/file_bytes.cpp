// SPDX-License-Identifier: BSD-3-Clause
#include "base/file_bytes.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

#include "base/descriptor.h"

namespace psi_slam {

std::string file_bytes(const std::filesystem::path& path, std::size_t most_bytes) {
  constexpr std::size_t kBlockBytes = std::size_t{1} << 18;
  const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC));
  if (!file.is_open()) throw std::system_error(errno, std::generic_category());
  std::string bytes;
  for (std::size_t done = 0;;) {
    bytes.resize(done + kBlockBytes);
    const ssize_t count = ::read(file.number(), bytes.data() + done, kBlockBytes);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw std::system_error(errno, std::generic_category());
    done += static_cast<std::size_t>(count);
    bytes.resize(done);
    if (count == 0 || done > most_bytes) return bytes;
  }
}

}  // namespace psi_slam
