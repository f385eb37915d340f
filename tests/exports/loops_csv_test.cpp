// SPDX-License-Identifier: BSD-3-Clause
#include "exports/loops_csv.h"

#include <gmock/gmock.h>

#include <sstream>

#include "simulated_room.h"

namespace psi_slam {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

TEST(LoopsCsv, has_a_row_for_each_attempt_with_its_verdict_and_reason) {
  const MappingResult result = walk_around_the_room();
  std::istringstream text(loops_csv(result.loops));
  std::string header;
  std::string refused;
  std::string accepted;
  std::getline(text, header);
  std::getline(text, refused);
  std::getline(text, accepted);
  EXPECT_THAT(
      header,
      StartsWith(
          "frame,node,local_map,anchor,verdict,reason,matcher,in_last_pass,by_hand,x_m,y_m,theta_rad,"));
  EXPECT_THAT(refused, StartsWith("25,5,0,0,refused,\"the response is too low: 0.41, minimum 0.55\",csm,0,0,"));
  EXPECT_THAT(accepted, StartsWith("45,9,0,0,accepted,,csm,0,0,"));
  EXPECT_THAT(accepted, HasSubstr(",0.010000,0.010000,0.010000,"));
  EXPECT_EQ(std::count(header.begin(), header.end(), ','), std::count(accepted.begin(), accepted.end(), ','));
  EXPECT_FALSE(std::getline(text, header));
}

}  // namespace
}  // namespace psi_slam
