// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/g2o_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <string>
#include <string_view>
#include <system_error>

#include "base/atomic_file.h"
#include "base/compression/line_reader.h"
#include "base/number_text.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/spanning_tree.h"
#include "psi_slam/user_error.h"

namespace psi_slam {
namespace {

using mrpt::math::TPose2D;

// A vertex line, or a FIX line, which has no pose.
struct Vertex {
  std::int64_t id = 0;
  std::size_t line = 0;
  TPose2D pose{};
};

struct Edge {
  std::size_t line = 0;
  std::int64_t from = 0;
  std::int64_t to = 0;
  TPose2D from_T_to;
  Eigen::Matrix3d information;  // in the axes of `from`
};

// As in_turned_axes(), without the asymmetry of rounding. The information matrix of an EDGE_SE2 has the axes
// of the edge's end; those of an EDGE2 and of the graph have the axes of its beginning.
Eigen::Matrix3d symmetric_in_turned_axes(const Eigen::Matrix3d& information, double angle_rad) {
  const Eigen::Matrix3d product = in_turned_axes(information, angle_rad);
  return 0.5 * (product + product.transpose());
}

// Layout of an edge: the entries of its information matrix as (row, column), and the axes of the matrix.
struct EdgeFormat {
  const char* layout;
  std::array<std::array<int, 2>, 6> entries;
  bool in_axes_of_end;
};
constexpr EdgeFormat kG2oEdge{"EDGE_SE2 from to dx dy dtheta Ixx Ixy Ixt Iyy Iyt Itt",
                              {{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}},
                              true};
constexpr EdgeFormat kToroEdge{"EDGE2 from to dx dy dtheta Ixx Ixy Iyy Itt Ixt Iyt",
                               {{{0, 0}, {0, 1}, {1, 1}, {2, 2}, {0, 2}, {1, 2}}},
                               false};

// Reads the words of a line one by one. Throws UserError with the expected layout if a word is not as
// expected.
class Fields {
 public:
  Fields(std::string_view line, const LineReader& reader) : rest_(line), reader_(reader) {}

  void expect(const char* layout) { layout_ = layout; }

  // Returns the next word; empty at the end of the line.
  std::string_view word() {
    constexpr std::string_view kBlank = " \t\r";
    const std::size_t begin = std::min(rest_.find_first_not_of(kBlank), rest_.size());
    rest_.remove_prefix(begin);
    const std::string_view result = rest_.substr(0, rest_.find_first_of(kBlank));
    rest_.remove_prefix(result.size());
    return result;
  }

  std::int64_t id() {
    const std::string_view text = word();
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size())
      throw bad("'" + std::string(text) + "' is not a vertex id");
    return value;
  }

  double number() {
    const std::string_view text = word();
    const std::optional<double> value = parse_number(text);
    if (!value) throw bad("'" + std::string(text) + "' is not a finite number");
    return *value;
  }

  TPose2D pose() {
    const double x = number();
    const double y = number();
    return {x, y, number()};
  }

  Edge edge(const EdgeFormat& format) {
    expect(format.layout);
    Edge edge;
    edge.line = reader_.line_number();
    edge.from = id();
    edge.to = id();
    edge.from_T_to = pose();
    for (const auto& [row, column] : format.entries)
      edge.information(row, column) = edge.information(column, row) = number();
    end();
    if (!is_information_matrix(edge.information))
      throw bad("the information matrix is not positive semi-definite");
    if (edge.from == edge.to) throw bad("an edge links a vertex to itself");
    if (format.in_axes_of_end)
      edge.information = symmetric_in_turned_axes(edge.information, edge.from_T_to.phi);
    return edge;
  }

  void end() {
    const std::string_view text = word();
    if (!text.empty()) throw bad("'" + std::string(text) + "' is an extra field");
  }

  UserError bad(const std::string& what) const {
    return UserError(reader_.place() + ": " + what + ", expected \"" + layout_ + "\". Correct the line");
  }

 private:
  std::string_view rest_;
  const LineReader& reader_;
  const char* layout_ = "";
};

struct Contents {
  std::vector<Vertex> vertices;
  std::vector<Edge> edges;
  std::optional<Vertex> fix;
};

Contents read_lines(const std::filesystem::path& path) {
  Contents contents;
  LineReader reader(path);
  std::string_view line;
  while (reader.next(line)) {
    Fields fields(line, reader);
    const std::string_view tag = fields.word();
    if (tag.empty() || tag.front() == '#') continue;
    if (tag == "VERTEX_SE2" || tag == "VERTEX2") {
      fields.expect(tag == "VERTEX2" ? "VERTEX2 id x y theta" : "VERTEX_SE2 id x y theta");
      const std::int64_t id = fields.id();
      contents.vertices.push_back({id, reader.line_number(), fields.pose()});
      fields.end();
    } else if (tag == "EDGE_SE2") {
      contents.edges.push_back(fields.edge(kG2oEdge));
    } else if (tag == "EDGE2") {
      contents.edges.push_back(fields.edge(kToroEdge));
    } else if (tag == "FIX") {
      fields.expect("FIX id");
      const Vertex fix{fields.id(), reader.line_number()};
      if (contents.fix && contents.fix->id != fix.id)
        throw fields.bad("a second vertex is fixed after line " + std::to_string(contents.fix->line));
      fields.end();
      contents.fix = fix;
    } else {
      throw UserError(
          reader.place() + ": '" + std::string(tag.substr(0, 40)) +
          "' is not an entry of a 2D pose graph, expected VERTEX_SE2, EDGE_SE2, FIX, VERTEX2 or EDGE2. "
          "Remove the line");
    }
  }
  return contents;
}

/// Information of a heading that is not known: a standard deviation of 1000 rad. GTSAM refuses files with 0.
constexpr double kNoHeading = 1e-6;

std::string place(const std::filesystem::path& path, std::size_t line) {
  return path.string() + ":" + std::to_string(line);
}

void append(std::string& text, double value) {
  std::array<char, 32> digits{};
  const auto result = std::to_chars(digits.data(), digits.data() + digits.size(), value == 0 ? 0.0 : value);
  text += ' ';
  text.append(digits.data(), result.ptr);
}

}  // namespace

PoseGraphFile read_pose_graph(const std::filesystem::path& path) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored))
    throw UserError(path.string() +
                    " does not exist, expected a pose graph in g2o or TORO format. Check the path");
  Contents contents = read_lines(path);
  if (contents.vertices.empty() && contents.edges.empty())
    throw UserError(path.string() +
                    " contains no pose graph, expected VERTEX_SE2 and EDGE_SE2 lines. Choose another file");

  PoseGraphFile result;
  const bool without_poses = contents.vertices.empty();
  if (without_poses) {
    for (const Edge& edge : contents.edges) {
      contents.vertices.push_back({edge.from, edge.line});
      contents.vertices.push_back({edge.to, edge.line});
    }
  }
  std::stable_sort(contents.vertices.begin(), contents.vertices.end(),
                   [](const Vertex& a, const Vertex& b) { return a.id < b.id; });
  for (const Vertex& vertex : contents.vertices) {
    if (!result.ids.empty() && result.ids.back() == vertex.id) {
      if (without_poses) continue;
      throw UserError(place(path, vertex.line) + ": vertex " + std::to_string(vertex.id) +
                      " is defined twice, expected every id once. Remove one of the lines");
    }
    result.ids.push_back(vertex.id);
    result.graph.add_node(vertex.pose);
  }
  const auto existing = [&](std::int64_t id, std::size_t line) {
    const auto found = std::lower_bound(result.ids.begin(), result.ids.end(), id);
    if (found == result.ids.end() || *found != id)
      throw UserError(place(path, line) + ": vertex " + std::to_string(id) +
                      " is missing, expected a line VERTEX_SE2 (or VERTEX2) for it. Add the line");
    return static_cast<std::size_t>(found - result.ids.begin());
  };
  for (const Edge& edge : contents.edges) {
    Constraint constraint;
    constraint.from = existing(edge.from, edge.line);
    constraint.to = existing(edge.to, edge.line);
    constraint.from_T_to = edge.from_T_to;
    constraint.information = edge.information;
    const bool successive = constraint.from + 1 == constraint.to || constraint.to + 1 == constraint.from;
    constraint.kind = successive ? Constraint::Kind::kOdometry : Constraint::Kind::kLoop;
    result.graph.add_constraint(constraint);
  }
  if (contents.fix) result.graph.set_root(existing(contents.fix->id, contents.fix->line));
  if (without_poses) {
    const std::vector<TPose2D> poses = spanning_tree_poses(result.graph);
    for (std::size_t node = 0; node < poses.size(); ++node) result.graph.set_pose(node, poses[node]);
  }
  return result;
}

void write_g2o(const PoseGraph& graph, const std::filesystem::path& path) {
  std::string text;
  const auto append_pose = [&](const TPose2D& pose) {
    append(text, pose.x);
    append(text, pose.y);
    append(text, pose.phi);
  };
  for (std::size_t node = 0; node < graph.num_nodes(); ++node) {
    text += "VERTEX_SE2 " + std::to_string(node);
    append_pose(graph.pose(node));
    text += '\n';
  }
  if (graph.num_nodes() > 0) text += "FIX " + std::to_string(graph.root()) + '\n';
  for (std::size_t i = 0; i < graph.num_constraints(); ++i) {
    if (!graph.enabled(i)) continue;
    const Constraint& constraint = graph.constraint(i);
    text += "EDGE_SE2 " + std::to_string(constraint.from) + ' ' + std::to_string(constraint.to);
    append_pose(constraint.from_T_to);
    Eigen::Matrix3d information = symmetric_in_turned_axes(constraint.information, -constraint.from_T_to.phi);
    if (information(2, 2) == 0) information(2, 2) = kNoHeading;
    for (const auto& [row, column] : kG2oEdge.entries) append(text, information(row, column));
    text += '\n';
  }
  write_text_atomically(path, text);
}

}  // namespace psi_slam
