// SPDX-License-Identifier: BSD-3-Clause
#include "map/exports/live_map_writer.h"

#include <gmock/gmock.h>

#include "map/exports/map_files.h"
#include "map/exports/map_server_pair.h"
#include "simulated_room.h"
#include "soon.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

namespace fs = std::filesystem;

class LiveMapWriterTest : public testing::Test {
 protected:
  /// Returns the frames of half a round, in which the robot closes no loop.
  static std::vector<Frame> half_round() {
    std::vector<Frame> frames = walk_around_the_room(80).log;
    frames.resize(40);
    return frames;
  }

  /// Bytes of the pair that write_map_server_pair() writes of the whole map.
  std::string expected_image() const {
    LivePoses poses;
    poses.take(mapper_.frames());
    std::vector<mrpt::math::TPose2D> map_T_robot;
    for (std::size_t i = 0; i < mapper_.log().size(); ++i)
      map_T_robot.push_back(poses.map_T_robot(i, mapper_.frames(), mapper_.node_poses()));
    GridMapOptions everything;
    everything.keep_moving = true;
    everything.min_beams = 1;
    fs::create_directory(folder_.path() / "expected");
    write_map_server_pair(folder_.path() / "expected" / "map.yaml",
                          *draw_grid_map(mapper_.log(), map_T_robot, everything));
    return read_file(folder_.path() / "expected" / "map.pgm");
  }

  fs::path image() const { return folder_.path() / "map.pgm"; }
  fs::path yaml() const { return folder_.path() / "map.yaml"; }

  const std::vector<Frame> frames_ = half_round();
  Mapper mapper_;
  TemporaryFolder folder_;
};

TEST_F(LiveMapWriterTest, writes_the_map_of_all_scans_so_far) {
  LiveMapWriter writer(folder_.path(), {}, 1e-3);
  for (const Frame& frame : frames_) {
    mapper_.add(frame);
    writer.update(mapper_);
  }
  const std::string expected = expected_image();
  EXPECT_TRUE(soon([&] {
    writer.update(mapper_);
    return fs::exists(yaml()) && read_file(image()) == expected;
  }));
  EXPECT_FALSE(writer.failure());
}

TEST_F(LiveMapWriterTest, writes_only_if_the_map_has_changed) {
  LiveMapWriter writer(folder_.path(), {}, 1e-3);
  mapper_.add(frames_[0]);
  EXPECT_TRUE(soon([&] {
    writer.update(mapper_);
    return fs::exists(yaml());
  }));
  fs::remove(yaml());
  for (int i = 0; i < 20; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
    writer.update(mapper_);
  }
  EXPECT_FALSE(fs::exists(yaml()));
}

TEST_F(LiveMapWriterTest, a_period_of_0_writes_nothing) {
  {
    LiveMapWriter writer(folder_.path(), {}, 0);
    mapper_.add(frames_[0]);
    writer.update(mapper_);
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(LiveMapWriterTest, waits_for_the_period) {
  {
    LiveMapWriter writer(folder_.path(), {}, 3600);
    for (const Frame& frame : frames_) {
      mapper_.add(frame);
      writer.update(mapper_);
    }
  }
  EXPECT_TRUE(fs::is_empty(folder_.path()));
}

TEST_F(LiveMapWriterTest, tells_why_it_cannot_write_and_tries_again) {
  const fs::path missing = folder_.path() / "later";
  LiveMapWriter writer(missing, {}, 1e-3);
  mapper_.add(frames_[0]);
  ASSERT_TRUE(soon([&] {
    writer.update(mapper_);
    return writer.failure().has_value();
  }));
  EXPECT_THAT(*writer.failure(), testing::HasSubstr("map.pgm"));
  fs::create_directory(missing);
  std::size_t next = 1;
  EXPECT_TRUE(soon([&] {
    if (next < frames_.size()) mapper_.add(frames_[next++]);
    writer.update(mapper_);
    return !writer.failure() && fs::exists(missing / "map.yaml");
  }));
}

}  // namespace
}  // namespace psi_slam
