// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <functional>
#include <future>
#include <vector>

#include "session/session_input.h"

namespace psi_slam {

/// Reads sessions, and checks logs against them, in another thread. A read that is given up still runs to its
/// end, and the destructor waits for it.
class SessionReader {
 public:
  using Read = std::function<SessionInput()>;
  using Take = std::function<void(SessionInput)>;

  /// Calls `read` in another thread; it must own all that it uses. Gives up the previous read.
  void begin(Read read, Take take);
  void give_up();

  /// Calls `take` if a read has ended; call it regularly. Rethrows what `read` threw.
  void serve();

 private:
  std::future<SessionInput> reading_;
  Take take_;
  std::vector<std::future<SessionInput>> given_up_;  // until they end
};

}  // namespace psi_slam
