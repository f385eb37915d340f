// SPDX-License-Identifier: BSD-3-Clause
#include "mapping/local_maps/correction_support.h"

#include <gtest/gtest.h>

#include <vector>

namespace psi_slam {
namespace {

using mrpt::math::TPoint2Df;
using mrpt::math::TPose2D;

// A scan of a person at (2, 0) and of other objects. The grid holds all of them as seen from kMatched, the
// matched pose. Objects with `both` are also in the grid as seen from kHeld, the pose kept close to odometry.
const TPose2D kMatched(0, 0, 0);
const TPose2D kHeld(0.5, 0, 0);
const std::vector<TPoint2Df> kPerson = {{2, 0}, {2, 0.1F}, {2, 0.2F}, {2, -0.1F}, {2, -0.2F}};

class CorrectionSupport : public testing::Test {
 protected:
  void stand(const TPoint2Df& at, bool both) {
    scan_.points.push_back(at);
    mark(at.x, at.y);
    if (both) mark(at.x + 0.5F, at.y);
  }
  CorrectionScores scores(const TPose2D& held = kHeld) const {
    return scores_without_best_spot(grid_, scan_, kMatched, held);
  }

 private:
  // Marks a patch of cells, because interpolation uses neighbouring cells.
  void mark(float x, float y) {
    const int column = static_cast<int>((static_cast<double>(x) + 5) / 0.05);
    const int row = static_cast<int>((static_cast<double>(y) + 5) / 0.05);
    for (int j = -3; j <= 3; ++j)
      for (int i = -3; i <= 3; ++i) *grid_.finest().cell(column + i, row + j) = 255;
  }

  ScoreGrid grid_{-5, -5, 0.05, 200, 200};
  ScanPoints scan_;
};

TEST_F(CorrectionSupport, one_spot_alone_is_no_support) {
  for (const TPoint2Df& point : kPerson) stand(point, false);
  for (const float y : {-3.0F, -2.0F, 2.0F, 3.0F}) stand({-1, y}, true);
  EXPECT_NEAR(scores().matched, 1, 1e-6);
  EXPECT_NEAR(scores().held, 1, 1e-6) << "without the person, both poses score the same";
}

TEST_F(CorrectionSupport, two_spots_support_without_the_better_one) {
  for (const TPoint2Df& point : kPerson) stand(point, false);
  stand({-2, 1}, false);  // a door post
  stand({-2, -1}, true);
  EXPECT_NEAR(scores().matched, 1, 1e-6);
  EXPECT_NEAR(scores().held, 0.5, 1e-6);
}

TEST_F(CorrectionSupport, counts_every_point_without_a_gain) {
  for (const TPoint2Df& point : kPerson) stand(point, true);
  stand({-2, 1}, true);
  EXPECT_NEAR(scores().matched, 1, 1e-6);
  EXPECT_NEAR(scores().held, 1, 1e-6);
  EXPECT_NEAR(scores(kMatched).held, scores(kMatched).matched, 1e-12);
}

TEST_F(CorrectionSupport, a_scan_of_one_spot_has_no_support) {
  for (const TPoint2Df& point : kPerson) stand(point, false);
  EXPECT_EQ(scores().matched, 0);
  EXPECT_EQ(scores().held, 0);
}

}  // namespace
}  // namespace psi_slam
