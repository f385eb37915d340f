// SPDX-License-Identifier: BSD-3-Clause
#include "live/line_streams.h"

#include <gmock/gmock.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <fstream>
#include <thread>

#include "base/descriptor.h"
#include "sender.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Reads a stream in a thread of its own, until it ends or the object is destroyed.
class ReadingThread {
 public:
  /// `stop` ends the stream.
  ReadingThread(std::unique_ptr<LineStream> stream, std::atomic<bool>& stop)
      : stop_(stop), thread_([this, stream = std::move(stream)] {
          std::array<char, 7> bytes{};
          while (const std::size_t size = stream->read(bytes.data(), bytes.size())) {
            const std::lock_guard lock(mutex_);
            text_.append(bytes.data(), size);
          }
        }) {}
  ~ReadingThread() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
  }
  ReadingThread(const ReadingThread&) = delete;
  ReadingThread& operator=(const ReadingThread&) = delete;

  std::string text() {
    const std::lock_guard lock(mutex_);
    return text_;
  }
  /// Returns all text after the stream has ended.
  std::string rest() {
    thread_.join();
    return text_;
  }

 private:
  std::atomic<bool>& stop_;
  std::mutex mutex_;
  std::string text_;
  std::thread thread_;
};

class LineStreamsTest : public testing::Test {
 protected:
  LiveControl control() {
    return {[this] { return stop_.load(); }, [this](const std::string& notice) { notices_.add(notice); }};
  }

  TemporaryFolder folder_;
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

TEST_F(LineStreamsTest, follows_a_file_that_grows) {
  const auto file = folder_.path() / "my.log";
  write_file(file, "");
  ReadingThread reader(growing_file(file, control(), std::nullopt), stop_);
  std::ofstream recorder(file, std::ios::app);
  recorder << "one\ntw" << std::flush;
  EXPECT_TRUE(soon([&] { return reader.text() == "one\n"; }));
  recorder << "o\n" << std::flush;
  EXPECT_TRUE(soon([&] { return reader.text() == "one\ntwo\n"; }));
  stop_ = true;
  EXPECT_EQ(reader.rest(), "one\ntwo\n");
}

TEST_F(LineStreamsTest, a_file_that_stops_growing_ends_as_a_log) {
  const auto file = folder_.path() / "my.log";
  write_file(file, "FLASER one\nFLASER two");
  EXPECT_EQ(ReadingThread(growing_file(file, control(), 0.0), stop_).rest(), "FLASER one\nFLASER two");
}

TEST_F(LineStreamsTest, a_followed_file_must_not_shrink) {
  const auto file = folder_.path() / "my.log";
  write_file(file, "one\n");
  const auto stream = growing_file(file, control(), std::nullopt);
  std::array<char, 9> bytes{};
  EXPECT_EQ(stream->read(bytes.data(), bytes.size()), 4U);
  write_file(file, "");
  EXPECT_THAT(sentence_of([&] { stream->read(bytes.data(), bytes.size()); }),
              HasSubstr("my.log became shorter while it was followed"));
}

TEST_F(LineStreamsTest, says_which_files_cannot_be_followed) {
  const auto complaint = [&](const std::string& bytes) {
    const auto file = folder_.path() / "log";
    write_file(file, bytes);
    return sentence_of([&] { growing_file(file, control(), std::nullopt); });
  };
  EXPECT_THAT(complaint("#ROSBAG V2.0\n"), HasSubstr("log is a ROS 1 bag and cannot be followed"));
  EXPECT_THAT(complaint("\x89MCAP0\r\n"), HasSubstr("log is a ROS 2 bag (MCAP) and cannot be followed"));
  EXPECT_THAT(complaint("\x98"
                        "CObservation2DRangeScan"),
              HasSubstr("is a MRPT rawlog and cannot be followed"));
  EXPECT_THAT(complaint("\x1f\x8b\x08"), HasSubstr("log is compressed and cannot be followed"));
  EXPECT_THAT(sentence_of([&] { growing_file(folder_.path(), control(), std::nullopt); }),
              HasSubstr("is a folder and cannot be followed"));
  const auto pipe = folder_.path() / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), S_IRUSR | S_IWUSR), 0);
  EXPECT_THAT(sentence_of([&] { growing_file(pipe, control(), std::nullopt); }),
              AllOf(HasSubstr("pipe is no regular file"), HasSubstr("Pipe it to --stdin")));
  EXPECT_THAT(sentence_of([&] { growing_file(folder_.path() / "none", control(), std::nullopt); }),
              HasSubstr("none does not exist"));
}

}  // namespace
}  // namespace psi_slam
