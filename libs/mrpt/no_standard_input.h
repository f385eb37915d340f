// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace psi_slam {

/// While it lives, the process reads nothing from standard input: MRPT 2.5.8's engine does not recognise the
/// name of its own graph's class, warns of it and waits for a key.
class NoStandardInput {
 public:
  NoStandardInput();
  ~NoStandardInput();
  NoStandardInput(const NoStandardInput&) = delete;
  NoStandardInput& operator=(const NoStandardInput&) = delete;

 private:
  int kept_ = -1;
};

}  // namespace psi_slam
