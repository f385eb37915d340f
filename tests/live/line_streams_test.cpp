// SPDX-License-Identifier: BSD-3-Clause
#include "live/line_streams.h"

#include <gmock/gmock.h>
#include <unistd.h>

#include <array>
#include <atomic>

#include "base/descriptor.h"
#include "reading_thread.h"
#include "sender.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class LineStreamsTest : public testing::Test {
 protected:
  LiveControl control() {
    return {[this] { return stop_.load(); }, [this](const std::string& notice) { notices_.add(notice); }};
  }

  Notices notices_;
  std::atomic<bool> stop_ = false;
};

TEST_F(LineStreamsTest, standard_input_ends_with_its_last_bytes) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const Descriptor input(ends[0]);
  Descriptor sender(ends[1]);
  ReadingThread reader(standard_input(control(), std::nullopt, input.number()), stop_);
  send_text(sender.number(), "one\ntw");
  EXPECT_TRUE(soon([&] { return reader.text() == "one\n"; })) << "whole lines come at once";
  send_text(sender.number(), "o\nthree");
  sender.close();
  EXPECT_EQ(reader.rest(), "one\ntwo\nthree") << "as a file with the same bytes";
}

TEST_F(LineStreamsTest, the_user_ends_a_stream_and_its_incomplete_line) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const Descriptor input(ends[0]);
  const Descriptor sender(ends[1]);
  ReadingThread reader(standard_input(control(), std::nullopt, input.number()), stop_);
  send_text(sender.number(), "one\ntw");
  EXPECT_TRUE(soon([&] { return reader.text() == "one\n"; }));
  stop_ = true;
  EXPECT_EQ(reader.rest(), "one\n");
}

TEST_F(LineStreamsTest, a_stream_ends_if_nothing_comes) {
  std::array<int, 2> ends{};
  ASSERT_EQ(::pipe(ends.data()), 0);
  const Descriptor input(ends[0]);
  const Descriptor sender(ends[1]);
  send_text(sender.number(), "one\n");
  EXPECT_EQ(ReadingThread(standard_input(control(), 0.0, input.number()), stop_).rest(), "one\n");
}

TEST_F(LineStreamsTest, a_tcp_port_serves_one_sender_after_the_other) {
  ReadingThread reader(tcp_input("127.0.0.1", 0, control(), std::nullopt), stop_);
  const int port = notices_.port();
  {
    const Descriptor first = connect_to(port);
    send_text(first.number(), "one\nincompl");
    EXPECT_TRUE(soon([&] { return reader.text() == "one\n"; }));
    const Descriptor waiting = connect_to(port);
    send_text(waiting.number(), "two\n");
  }
  const Descriptor second = connect_to(port);
  send_text(second.number(), "three\n");
  EXPECT_TRUE(soon([&] { return reader.text() == "one\nincompl\ntwo\nthree\n"; })) << reader.text();
  stop_ = true;
  reader.rest();
  EXPECT_THAT(notices_.text(), AllOf(HasSubstr("listening on 127.0.0.1:" + std::to_string(port)),
                                     HasSubstr("connected to the sender at 127.0.0.1"),
                                     HasSubstr("the sender disconnected, waiting for another one")));
}

TEST_F(LineStreamsTest, a_sender_that_resets_the_connection_may_return) {
  ReadingThread reader(tcp_input("127.0.0.1", 0, control(), std::nullopt), stop_);
  const int port = notices_.port();
  {
    const Descriptor first = connect_to(port);
    send_text(first.number(), "one\n");
    EXPECT_TRUE(soon([&] { return reader.text() == "one\n"; }));
    reset_when_closed(first.number());
  }
  const Descriptor second = connect_to(port);
  send_text(second.number(), "two\n");
  EXPECT_TRUE(soon([&] { return reader.text() == "one\ntwo\n"; })) << reader.text();
  stop_ = true;
}

TEST_F(LineStreamsTest, rejects_addresses_and_ports_that_cannot_be_opened) {
  EXPECT_THAT(sentence_of([&] { tcp_input("example", 0, control(), std::nullopt); }),
              HasSubstr("--bind example: expected an IPv4 address"));
  EXPECT_THAT(sentence_of([&] { tcp_input("192.0.2.1", 0, control(), std::nullopt); }),
              AllOf(HasSubstr("cannot listen on port 0 of 192.0.2.1"), HasSubstr("--bind")));
  const auto first = tcp_input("127.0.0.1", 0, control(), std::nullopt);
  const auto port = static_cast<std::uint16_t>(notices_.port());
  EXPECT_THAT(sentence_of([&] { tcp_input("127.0.0.1", port, control(), std::nullopt); }),
              AllOf(HasSubstr("Address already in use"), HasSubstr("Choose another port with --tcp")));
}

}  // namespace
}  // namespace psi_slam
