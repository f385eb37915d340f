// SPDX-License-Identifier: BSD-3-Clause
#include "session/journal_chunks.h"

#include <gmock/gmock.h>

#include "base/byte_cursor.h"
#include "psi_slam/user_error.h"
#include "session/session_file.h"
#include "small_recording.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::HasSubstr;

class JournalChunksTest : public testing::Test {
 protected:
  /// Writes the scans 0, 1 to 2, and 3 of small_recording() as three chunks.
  JournalChunksTest() {
    const SessionRecording recording = small_recording();
    const std::vector<Frame>& frames = recording.frames;
    chunks_.push_back(journal_.next(facts_of_first(1), {frames[0]}));
    chunks_.push_back(journal_.next(facts_of_first(3), {frames[1], frames[2]}));
    chunks_.push_back(journal_.next(recording.facts, {frames[3]}));
  }

  /// Returns the facts of a run that has mapped the first `scans` scans of the first log.
  static SessionFacts facts_of_first(std::size_t scans) {
    SessionFacts facts = small_recording().facts;
    facts.logs.resize(1);
    facts.logs[0].scans = scans;
    facts.runs.clear();
    return facts;
  }

  SessionRecording read(const std::string& bytes) const {
    write_file(path_, bytes);
    return read_session_file(path_);
  }

  std::string complaint_about(const std::string& bytes) const {
    return sentence_of([&] { read(bytes); });
  }

  /// Returns the recording in these bytes, without a file; empty if they are damaged.
  std::optional<SessionRecording> read_bytes(const std::string& bytes) const {
    try {
      return read_journal(bytes, path_);
    } catch (const MalformedBytes&) {
    } catch (const UserError&) {  // the version is changed
    }
    return std::nullopt;
  }

  JournalChunks journal_;
  std::vector<std::string> chunks_;
  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "my.journal";
};

TEST_F(JournalChunksTest, chunks_give_one_recording) {
  const SessionRecording expected = small_recording();
  const SessionRecording back = read(chunks_[0] + chunks_[1] + chunks_[2]);
  EXPECT_TRUE(is_session_file(path_));
  EXPECT_FALSE(back.lost_end);
  ASSERT_EQ(back.frames.size(), 4U);
  for (std::size_t i = 0; i < 4; ++i) expect_same_frame(expected.frames[i], back.frames[i]);
  EXPECT_EQ(back.frames[0].scan.bearings_rad, back.frames[1].scan.bearings_rad)
      << "a sensor is described once";
  EXPECT_EQ(facts_text(back.facts), facts_text(expected.facts));
}

TEST_F(JournalChunksTest, every_number_of_chunks_is_a_recording) {
  for (const std::size_t chunks : {1U, 2U}) {
    const SessionRecording back = read(chunks_[0] + (chunks == 2 ? chunks_[1] : ""));
    EXPECT_EQ(back.frames.size(), chunks == 1 ? 1U : 3U);
    EXPECT_EQ(facts_text(back.facts), facts_text(facts_of_first(back.frames.size())));
  }
}

TEST_F(JournalChunksTest, facts_are_repeated_only_if_they_changed) {
  const std::vector<Frame> none;
  SessionFacts facts = facts_of_first(3);
  facts.settings = std::string(1000, 'x') + "\n";
  JournalChunks journal;
  std::string bytes = journal.next(facts, {});
  for (int i = 0; i < 2; ++i) {
    const std::string chunk = journal.next(facts, none);
    EXPECT_LT(chunk.size(), 130U);
    bytes += chunk;
  }
  facts.edits.add({{LoopEdit::Kind::kDelete, 1, 0}, {}});
  bytes += journal.next(facts, none);
  EXPECT_EQ(read(bytes).facts.edits.text(), facts.edits.text());
}

TEST_F(JournalChunksTest, ignores_an_incomplete_last_chunk_with_one_sentence) {
  const std::string whole = chunks_[0] + chunks_[1];
  EXPECT_FALSE(read(whole).lost_end);
  for (std::size_t size = 1; size < chunks_[2].size(); ++size) {
    const auto back = read_bytes(whole + chunks_[2].substr(0, size));
    ASSERT_TRUE(back && back->lost_end) << size;
    EXPECT_EQ(back->frames.size(), 3U) << size;
    EXPECT_THAT(*back->lost_end,
                HasSubstr("my.journal ends with an incomplete chunk of " + std::to_string(size) + " bytes"));
    EXPECT_EQ(back->facts.logs.size(), 1U);
  }
}

TEST_F(JournalChunksTest, ignores_a_last_chunk_that_never_reached_the_disk) {
  const SessionRecording back = read(chunks_[0] + chunks_[1] + std::string(chunks_[2].size(), '\0'));
  EXPECT_EQ(back.frames.size(), 3U);
  EXPECT_TRUE(back.lost_end);
}

TEST_F(JournalChunksTest, notices_every_flipped_bit) {
  const std::string bytes = chunks_[0] + chunks_[1] + chunks_[2];
  const std::size_t last = chunks_[0].size() + chunks_[1].size();
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::string flipped = bytes;
    flipped[i] = static_cast<char>(flipped[i] ^ (1 << (i % 8)));
    const auto back = read_bytes(flipped);
    ASSERT_EQ(back.has_value(), i >= last) << "byte " << i;
    if (!back) continue;
    EXPECT_EQ(back->frames.size(), 3U) << "byte " << i;
    EXPECT_TRUE(back->lost_end) << "byte " << i;
  }
}

TEST_F(JournalChunksTest, reports_a_damaged_chunk) {
  std::string bytes = chunks_[0] + chunks_[1] + chunks_[2];
  bytes[chunks_[0].size() + 30] ^= 1;
  EXPECT_THAT(complaint_about(bytes), HasSubstr("my.journal is damaged: the checksum of the chunk at byte " +
                                                std::to_string(chunks_[0].size()) + " does not match"));
  EXPECT_THAT(complaint_about(chunks_[0] + chunks_[2]), HasSubstr("my.journal is damaged"))
      << "a chunk is missing";
}

TEST_F(JournalChunksTest, reports_a_file_without_a_whole_chunk) {
  for (std::size_t size = kJournalMagic.size(); size < chunks_[0].size(); ++size)
    EXPECT_FALSE(read_bytes(chunks_[0].substr(0, size))) << size;
  EXPECT_THAT(complaint_about(chunks_[0].substr(0, 90)), HasSubstr("my.journal is damaged"));
  std::string newer = chunks_[0];
  newer[kJournalMagic.size()] = 9;
  EXPECT_THAT(complaint_about(newer), HasSubstr("of version 9, made by a newer psi-slam"));
}

}  // namespace
}  // namespace psi_slam
