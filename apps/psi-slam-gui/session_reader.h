// SPDX-License-Identifier: BSD-3-Clause
// Reads sessions, and checks logs against them, beside the window: it takes as long as the disk does. What is
// given up is read to its end nevertheless, and so long the program does not end, be its window closed.
#pragma once

#include <functional>
#include <future>
#include <vector>

#include "session/session_input.h"

namespace psi_slam {

class SessionReader {
 public:
  using Read = std::function<SessionInput()>;
  using Take = std::function<void(SessionInput)>;

  /// `read` is called in another thread and must hold all it needs. What was begun before is given up.
  void begin(Read read, Take take);
  void give_up();

  /// Hands over what has been read, once; to be called now and then. Throws what `read` threw.
  void serve();

 private:
  std::future<SessionInput> reading_;
  Take take_;
  std::vector<std::future<SessionInput>> given_up_;  // until they have ended
};

}  // namespace psi_slam
