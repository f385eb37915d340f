// SPDX-License-Identifier: BSD-3-Clause
// Tests reading floor plans in DXF files.
#include "session/plan_drawing.h"

#include <gmock/gmock.h>

#include "map/exports/map_files.h"
#include "psi_slam/user_error.h"
#include "temporary_folder.h"
#include "test_files.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// A room of 6 m by 4 m with a path through its middle, as runs write it.
MapDrawing room_with_path() {
  return {{{{0, 0}, {6, 0}, {6, 4}, {0, 4}}}, {{{1, 2}, {5, 2}}}, {0, 6, 0, 4}, 0.05};
}

class PlanDrawingTest : public testing::Test {
 protected:
  bool is_wall(const std::string& layers, float x_m, float y_m) const {
    return read_plan_drawing(path_, {{}, layers}).grid.getPos(x_m, y_m) < 0.5F;
  }

  TemporaryFolder folder_;
  const std::filesystem::path path_ = folder_.path() / "map.dxf";
};

TEST_F(PlanDrawingTest, the_path_in_the_drawing_of_a_run_is_no_wall) {
  write_file(path_, map_dxf(room_with_path()));
  EXPECT_TRUE(is_wall("", 3, 0.01F));
  EXPECT_FALSE(is_wall("", 3, 2.01F));
  EXPECT_TRUE(is_wall("WALLS, TRAJECTORY", 3, 2.01F)) << "a person may choose the layer";
  EXPECT_THAT(read_plan_drawing(path_, {}).layers, ElementsAre("TRAJECTORY", "WALLS"));
}

TEST_F(PlanDrawingTest, a_drawing_of_a_path_alone_is_refused) {
  MapDrawing path = room_with_path();
  path.walls.clear();
  write_file(path_, map_dxf(path));
  try {
    read_plan_drawing(path_, {});
    FAIL() << "a path became a wall";
  } catch (const UserError& error) {
    EXPECT_THAT(error.what(), HasSubstr("the drawing has no walls. Its layers are: TRAJECTORY"));
  }
}

}  // namespace
}  // namespace psi_slam
