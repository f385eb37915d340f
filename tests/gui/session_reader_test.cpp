// SPDX-License-Identifier: BSD-3-Clause
#include "session_reader.h"

#include <gtest/gtest.h>

#include <string>
#include <thread>

#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

class SessionReaderTest : public testing::Test {
 protected:
  SessionReader::Take take() {
    return [this](const SessionInput& input) { taken_.push_back(input.log().string()); };
  }
  void serve_until_taken(std::size_t count) {
    while (taken_.size() < count) {
      reader_.serve();
      std::this_thread::yield();
    }
  }

  std::vector<std::string> taken_;
  SessionReader reader_;
};

TEST_F(SessionReaderTest, hands_over_a_session_once_in_the_serving_thread) {
  std::thread::id read_in;
  std::promise<void> may_read;
  reader_.begin(
      [&] {
        may_read.get_future().wait();
        read_in = std::this_thread::get_id();
        return SessionInput("my.log");
      },
      take());
  reader_.serve();
  EXPECT_TRUE(taken_.empty()) << "serve() does not wait";
  may_read.set_value();
  serve_until_taken(1);
  reader_.serve();
  EXPECT_EQ(taken_, std::vector<std::string>{"my.log"});
  EXPECT_NE(read_in, std::this_thread::get_id());
}

TEST_F(SessionReaderTest, gives_up_the_previous_read) {
  std::promise<void> may_read;
  std::shared_future<void> allowed = may_read.get_future().share();
  reader_.begin([allowed] { return allowed.wait(), SessionInput("first.log"); }, take());
  reader_.begin([] { return SessionInput("second.log"); }, take());
  serve_until_taken(1);
  may_read.set_value();
  reader_.serve();
  EXPECT_EQ(taken_, std::vector<std::string>{"second.log"});
}

TEST_F(SessionReaderTest, rethrows_what_reading_threw_and_reads_again) {
  reader_.begin([]() -> SessionInput { throw UserError("my.session is damaged"); }, take());
  bool threw = false;
  while (!threw) {
    try {
      reader_.serve();
    } catch (const UserError& error) {
      EXPECT_STREQ(error.what(), "my.session is damaged");
      threw = true;
    }
  }
  reader_.serve();
  reader_.begin([] { return SessionInput("my.log"); }, take());
  serve_until_taken(1);
}

}  // namespace
}  // namespace psi_slam
