// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/g2o_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "base/atomic_file.h"
#include "dense_reference.h"
#include "psi_slam/user_error.h"
#include "shared_logs.h"
#include "temporary_folder.h"

namespace psi_slam {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

PoseGraphFile read_text(const std::string& text) {
  const TemporaryFolder folder;
  write_text_atomically(folder.path() / "graph.g2o", text);
  return read_pose_graph(folder.path() / "graph.g2o");
}

std::string error_of(const std::string& text) {
  try {
    read_text(text);
  } catch (const UserError& error) {
    return error.what();
  }
  return "no error";
}

std::string contents(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

constexpr const char* kTwoVertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";

TEST(G2oFile, reads_vertices_edges_and_the_fixed_one) {
  const PoseGraphFile file = read_text(
      "# a comment\n"
      "VERTEX_SE2 10 0 0 0.5\r\n"
      "\n"
      "EDGE_SE2 10 12 1.5 -2e-1 +0 1 2e-1 0 3 0 5\n"
      "  VERTEX_SE2\t12  1.25   -0.5 4\n"
      "VERTEX_SE2 11 3 3 0\n"
      "FIX 12\n"
      "EDGE_SE2 12 11 0 0 0 1 0 0 1 0 1");
  EXPECT_THAT(file.ids, ElementsAre(10, 11, 12));
  ASSERT_EQ(file.graph.num_nodes(), 3U);
  EXPECT_EQ(file.graph.root(), 2U);
  EXPECT_EQ(file.graph.pose(0), TPose2D(0, 0, 0.5));
  EXPECT_EQ(file.graph.pose(2).x, 1.25);
  EXPECT_NEAR(file.graph.pose(2).phi, 4 - 2 * M_PI, 1e-15) << "the heading is wrapped";
  ASSERT_EQ(file.graph.num_constraints(), 2U);
  const Constraint& loop = file.graph.constraint(0);
  EXPECT_EQ(loop.from, 0U);
  EXPECT_EQ(loop.to, 2U);
  EXPECT_EQ(loop.kind, Constraint::Kind::kLoop);
  EXPECT_EQ(loop.from_T_to, TPose2D(1.5, -0.2, 0));
  Eigen::Matrix3d information;
  information << 1, 0.2, 0, 0.2, 3, 0, 0, 0, 5;
  EXPECT_EQ(loop.information, information);
  EXPECT_EQ(file.graph.constraint(1).kind, Constraint::Kind::kOdometry);
}

TEST(G2oFile, orders_the_information_of_each_format_as_that_does) {
  // Both lines hold one matrix with the entries 100, 2, 90, 80, 4, 5, each in the order of its format.
  const std::string g2o = "EDGE_SE2 0 1 0 0 0 100 2 4 90 5 80\n";
  const std::string toro = "EDGE2 0 1 0 0 0 100 2 90 80 4 5\n";
  Eigen::Matrix3d expected;
  expected << 100, 2, 4, 2, 90, 5, 4, 5, 80;
  EXPECT_EQ(read_text(kTwoVertices + g2o).graph.constraint(0).information, expected);
  EXPECT_EQ(read_text(kTwoVertices + toro).graph.constraint(0).information, expected);
}

TEST(G2oFile, weighs_errors_in_the_axes_that_each_format_means) {
  // The edge turns by 90 degrees to the left: the x axis of its end is the y axis of its beginning.
  const std::string numbers = " 0 1 2 0 1.5707963267948966 ";
  const Eigen::Matrix3d g2o =
      read_text(kTwoVertices + ("EDGE_SE2" + numbers + "4 0 0 100 0 1\n")).graph.constraint(0).information;
  EXPECT_NEAR(g2o(0, 0), 100, 1e-9);
  EXPECT_NEAR(g2o(1, 1), 4, 1e-9);
  const Eigen::Matrix3d toro =
      read_text(kTwoVertices + ("EDGE2" + numbers + "4 0 100 1 0 0\n")).graph.constraint(0).information;
  EXPECT_NEAR(toro(0, 0), 4, 1e-9);
  EXPECT_NEAR(toro(1, 1), 100, 1e-9);
}

TEST(G2oFile, gives_the_chi2_that_g2o_computes) {
  const TPose2D from{0.3, -0.2, 0.7};
  const TPose2D to{1.4, 0.9, -2.1};
  const TPose2D measured{1.2, 0.4, 2.9};
  Eigen::Matrix3d information;
  information << 40, 7, -3, 7, 90, 5, -3, 5, 200;
  const PoseGraph graph =
      read_text(
          "VERTEX_SE2 0 0.3 -0.2 0.7\nVERTEX_SE2 1 1.4 0.9 -2.1\nEDGE_SE2 0 1 1.2 0.4 2.9 40 7 -3 90 5 200\n")
          .graph;
  const TPose2D delta = relative_pose(measured, relative_pose(from, to));  // z^-1 (x_i^-1 x_j)
  const Eigen::Vector3d error(delta.x, delta.y, delta.phi);
  EXPECT_NEAR(graph.chi2(), error.dot(information * error), 1e-9);
}

TEST(G2oFile, chains_edges_where_there_are_no_vertices) {
  const PoseGraphFile file = read_text(
      "EDGE_SE2 3 4 1 0 1.5707963267948966 1 0 0 1 0 1\n"
      "EDGE_SE2 4 5 2 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(file.ids, ElementsAre(3, 4, 5));
  EXPECT_NEAR(file.graph.pose(2).x, 1, 1e-12);
  EXPECT_NEAR(file.graph.pose(2).y, 2, 1e-12);
}

TEST(G2oFile, comes_back_as_it_was_written) {
  const TemporaryFolder folder;
  KnownGraph known = building(200, 2, 2);
  known.graph.set_root(3);
  known.graph.set_enabled(17, false);
  Constraint skewed = known.graph.constraint(5);
  skewed.information << 40.1, 7.7, -3.3, 7.7, 90.9, 5.5, -3.3, 5.5, 1000.0 / 3;
  known.graph.add_constraint(skewed);
  write_g2o(known.graph, folder.path() / "a.g2o");
  const PoseGraphFile file = read_pose_graph(folder.path() / "a.g2o");
  EXPECT_EQ(file.graph.poses(), known.graph.poses()) << "poses are equal to the last bit";
  EXPECT_EQ(file.graph.root(), 3U);
  ASSERT_EQ(file.graph.num_constraints(), known.graph.num_constraints() - 1);
  for (std::size_t i = 0; i < file.graph.num_constraints(); ++i) {
    const Constraint& read = file.graph.constraint(i);
    const Constraint& written = known.graph.constraint(i < 17 ? i : i + 1);
    EXPECT_EQ(read.from, written.from);
    EXPECT_EQ(read.to, written.to);
    EXPECT_EQ(read.from_T_to, written.from_T_to);
    EXPECT_LT((read.information - written.information).norm(), 1e-14 * written.information.norm());
  }
  EXPECT_NEAR(file.graph.chi2(), known.graph.chi2(), 1e-11 * known.graph.chi2());
}

TEST(G2oFile, is_written_as_the_format_says) {
  const TemporaryFolder folder;
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({0.1, -2.5, M_PI});
  Constraint constraint;
  constraint.to = 1;
  constraint.from_T_to = {0.25, 0, 0};
  constraint.information << 100, 2, 4, 2, 90, 5, 4, 5, 80;
  graph.add_constraint(constraint);
  write_g2o(graph, folder.path() / "a.g2o");
  EXPECT_EQ(contents(folder.path() / "a.g2o"),
            "VERTEX_SE2 0 0 0 0\n"
            "VERTEX_SE2 1 0.1 -2.5 3.141592653589793\n"
            "FIX 0\n"
            "EDGE_SE2 0 1 0.25 0 0 100 2 4 90 5 80\n");
}

TEST(G2oFile, known_position_has_no_singular_matrix) {
  const TemporaryFolder folder;
  PoseGraph graph;
  graph.add_node({0, 0, 0});
  graph.add_node({1, 0, 0});
  Constraint position;
  position.to = 1;
  position.from_T_to = {1, 0, 0};
  position.information = Eigen::Vector3d(100, 90, 0).asDiagonal();
  graph.add_constraint(position);
  write_g2o(graph, folder.path() / "a.g2o");
  EXPECT_THAT(contents(folder.path() / "a.g2o"), HasSubstr("EDGE_SE2 0 1 1 0 0 100 0 0 90 0 1e-06\n"));
}

TEST(G2oFile, says_what_is_wrong_and_where) {
  const std::string two(kTwoVertices);
  EXPECT_THAT(
      error_of(two + "EDGE_SE2 0 1 0 0 zero 1 0 0 1 0 1\n"),
      testing::AllOf(HasSubstr("graph.g2o:3: "), HasSubstr("'zero' is not a finite number"),
                     HasSubstr("expected \"EDGE_SE2 from to dx dy dtheta Ixx Ixy Ixt Iyy Iyt Itt\"")));
  EXPECT_THAT(error_of(two + "EDGE_SE2 0 1 0 0 0 1 0 0 1 0\n"), HasSubstr(":3: '' is not a finite number"));
  EXPECT_THAT(error_of(two + "EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1 7\n"), HasSubstr("'7' is an extra field"));
  EXPECT_THAT(error_of(two + "EDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n"),
              HasSubstr("'nan' is not a finite number"));
  EXPECT_THAT(error_of(two + "EDGE_SE2 0 1.5 0 0 0 1 0 0 1 0 1\n"), HasSubstr("'1.5' is not a vertex id"));
  EXPECT_THAT(error_of(two + "EDGE_SE2 0 1 0 0 0 1 5 0 1 0 1\n"), HasSubstr("not positive semi-definite"));
  EXPECT_THAT(error_of(two + "EDGE_SE2 1 1 0 0 0 1 0 0 1 0 1\n"), HasSubstr("to itself"));
  EXPECT_THAT(error_of(two + "\nEDGE_SE2 0 9 0 0 0 1 0 0 1 0 1\n"), HasSubstr(":4: vertex 9 is missing"));
  EXPECT_THAT(error_of(two + "VERTEX_SE2 1 5 5 0\n"), HasSubstr(":3: vertex 1 is defined twice"));
  EXPECT_THAT(error_of(two + "FIX 0\nFIX 1\n"), HasSubstr(":4: a second vertex is fixed after line 3"));
  EXPECT_THAT(error_of(two + "FIX 7\n"), HasSubstr(":3: vertex 7 is missing"));
  EXPECT_THAT(error_of(two + "VERTEX_SE3:QUAT 2 0 0 0 0 0 0 1\n"),
              HasSubstr(":3: 'VERTEX_SE3:QUAT' is not an entry of a 2D pose graph"));
  EXPECT_THAT(error_of(""), HasSubstr("contains no pose graph"));
  EXPECT_THAT(error_of("EDGE_SE2 0 1 0 0 0 1 0 0 1 0 1\nEDGE_SE2 5 6 0 0 0 1 0 0 1 0 1\n"),
              HasSubstr("is not linked to"));
  EXPECT_THROW(read_pose_graph("/nowhere/graph.g2o"), UserError);
}

TEST(G2oFile, that_cannot_be_written_is_said) {
  EXPECT_THROW(write_g2o(PoseGraph(), "/nowhere/graph.g2o"), SystemFailure);
}

TEST(G2oFile, reads_the_published_graphs) {
  struct Expected {
    const char* file;
    std::size_t nodes;
    std::size_t constraints;
  };
  for (const Expected& expected :
       {Expected{"input_INTEL_g2o.g2o.gz", 1228, 1483}, Expected{"CSAIL.g2o.gz", 1045, 1172},
        Expected{"killian-small.toro.gz", 1941, 3995}, Expected{"city10000.g2o.gz", 10000, 20687}}) {
    const auto path = shared_file(std::string("posegraphs/") + expected.file);
    if (!path) GTEST_SKIP() << kNeedsData;
    const PoseGraph graph = read_pose_graph(*path).graph;
    EXPECT_EQ(graph.num_nodes(), expected.nodes);
    EXPECT_EQ(graph.num_constraints(), expected.constraints);
  }
}

}  // namespace
}  // namespace psi_slam
