// SPDX-License-Identifier: BSD-3-Clause
#include "session_reader.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace psi_slam {
namespace {

bool has_ended(const std::future<SessionInput>& reading) {
  return reading.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
}

}  // namespace

void SessionReader::begin(Read read, Take take) {
  give_up();
  reading_ = std::async(std::launch::async, std::move(read));
  take_ = std::move(take);
}

void SessionReader::give_up() {
  if (reading_.valid()) given_up_.push_back(std::move(reading_));
}

void SessionReader::serve() {
  given_up_.erase(std::remove_if(given_up_.begin(), given_up_.end(), has_ended), given_up_.end());
  if (!reading_.valid() || !has_ended(reading_)) return;
  const Take take = std::exchange(take_, {});
  take(std::exchange(reading_, {}).get());
}

}  // namespace psi_slam
