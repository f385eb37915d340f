// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <functional>
#include <future>
#include <utility>
#include <vector>

#include "gui/background_thread.h"
#include "session/session_input.h"

namespace psi_slam {

/// Reads sessions, and checks the logs that continue them, in another thread. A read that is given up still
/// runs to its end, and the destructor waits for that.
class SessionReader {
 public:
  using Read = std::function<SessionInput()>;
  using Take = std::function<void(SessionInput)>;

  /// Calls `read` in another thread. `read` must own all data that it uses. Gives up the previous read.
  void begin(Read read, Take take) {
    give_up();
    reading_ = std::async(std::launch::async, std::move(read));
    take_ = std::move(take);
  }
  void give_up() {
    if (reading_.valid()) given_up_.push_back(std::move(reading_));
  }

  /// Calls `take` with the result when `read` has ended. Call serve() regularly. Rethrows exceptions of
  /// `read`.
  void serve() {
    given_up_.erase(std::remove_if(given_up_.begin(), given_up_.end(), has_ended<std::future<SessionInput>>),
                    given_up_.end());
    if (!reading_.valid() || !has_ended(reading_)) return;
    const Take take = std::exchange(take_, {});
    take(std::exchange(reading_, {}).get());
  }

 private:
  std::future<SessionInput> reading_;
  Take take_;
  std::vector<std::future<SessionInput>> given_up_;  // given-up reads that have not ended
};

}  // namespace psi_slam
