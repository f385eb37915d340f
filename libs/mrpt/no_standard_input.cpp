// SPDX-License-Identifier: BSD-3-Clause
#include "mrpt/no_standard_input.h"

#include <fcntl.h>
#include <unistd.h>

namespace psi_slam {

NoStandardInput::NoStandardInput() : kept_(::dup(STDIN_FILENO)) {
  const int nothing = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  if (nothing < 0) return;
  ::dup2(nothing, STDIN_FILENO);
  if (nothing != STDIN_FILENO) ::close(nothing);
}

NoStandardInput::~NoStandardInput() {
  if (kept_ < 0) {
    ::close(STDIN_FILENO);
  } else {
    ::dup2(kept_, STDIN_FILENO);
    ::close(kept_);
  }
}

}  // namespace psi_slam
