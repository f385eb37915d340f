// SPDX-License-Identifier: BSD-3-Clause
#include "pose_graph/known_landmarks.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"
#include "pose_graph/constraint_error.h"
#include "pose_graph/information_matrix.h"
#include "pose_graph/marginal_covariance.h"
#include "pose_graph/placed_covariances.h"
#include "pose_graph/shared_errors.h"
#include "psi_slam/user_error.h"

namespace psi_slam {

// A mark as a node saw it, and its place.
struct SeenMark {
  std::size_t node = 0;
  MeasuredPose node_T_mark;
  MeasuredPose site_T_mark;

  bool has_heading() const { return node_T_mark.sigma_rad && site_T_mark.sigma_rad; }
};

namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using mrpt::math::TPose2D;

Matrix3d covariance_of(const MeasuredPose& measured) {
  const double of_heading = measured.sigma_rad.value_or(0);
  const double of_position = measured.sigma_m * measured.sigma_m;
  return Matrix3d(Vector3d(of_position, of_position, of_heading * of_heading).asDiagonal()) +
         measured.further;
}

Matrix3d information_of(const MeasuredPose& measured) {
  Matrix3d information = Matrix3d::Zero();
  if (measured.sigma_rad)
    information = noisy_information(measured.further, measured.sigma_m, *measured.sigma_rad);
  else
    information.topLeftCorner<2, 2>() = covariance_of(measured).topLeftCorner<2, 2>().inverse();
  return information;
}

Constraint known_constraint(std::size_t from, std::size_t to, const MeasuredPose& from_T_to) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.from_T_to = from_T_to.pose;
  constraint.information = information_of(from_T_to);
  constraint.kind = Constraint::Kind::kKnown;
  constraint.kernel = RobustKernel{};  // consistent() has left out what is false; the rest holds
  return constraint;
}

// Keeps a node connected with the graph, and determines a heading that no measurement determines.
Constraint weak_link(std::size_t from, std::size_t to) {
  Constraint constraint;
  constraint.from = from;
  constraint.to = to;
  constraint.information = noisy_information(Matrix3d::Zero(), kProvisionalSigma_m, kProvisionalSigma_rad);
  constraint.kind = Constraint::Kind::kRunStart;
  return constraint;
}

// What two marks have in common: their relative pose, or less if headings are unknown.
enum class Comparison { kPose, kPositionFromA, kPositionFromB, kDistance };

int dimensions(Comparison comparison) {
  return comparison == Comparison::kPose ? 3 : comparison == Comparison::kDistance ? 1 : 2;
}

// Poses that a comparison depends on: of node b in node a, of each mark in its node, of each mark in the
// site.
using Poses = Eigen::Matrix<double, 15, 1>;

TPose2D pose_at(const Poses& poses, int index) {
  return {poses[3 * index], poses[3 * index + 1], poses[3 * index + 2]};
}

void set(Poses& poses, int index, const TPose2D& pose) {
  poses.segment<3>(3 * index) << pose.x, pose.y, pose.phi;
}

Vector3d difference(const TPose2D& a, const TPose2D& b) {
  return {a.x - b.x, a.y - b.y, wrap_to_pi(a.phi - b.phi)};
}

// Difference between the relative pose of two marks by the graph and by their places. Only the first
// dimensions(comparison) entries count.
Vector3d disagreement(const Poses& poses, Comparison comparison) {
  const TPose2D by_graph = compose(inverse(pose_at(poses, 1)), compose(pose_at(poses, 0), pose_at(poses, 2)));
  const TPose2D by_site = between(pose_at(poses, 3), pose_at(poses, 4));
  if (comparison == Comparison::kPositionFromB) return difference(inverse(by_graph), inverse(by_site));
  if (comparison == Comparison::kDistance)
    return {portable::hypot(by_graph.x, by_graph.y) - portable::hypot(by_site.x, by_site.y), 0, 0};
  return difference(by_graph, by_site);
}

// Difference between the relative pose of two marks by the graph and by their places, and its covariance.
struct Disagreement {
  Eigen::VectorXd error;
  MatrixXd of_drift;       // covariance by the pose of one node relative to the other
  MatrixXd of_statements;  // covariance by the sightings and the places

  /// Returns e^T C^-1 e.
  double chi2() const { return std::max(0.0, error.dot((of_drift + of_statements).ldlt().solve(error))); }
};

// `a_T_b` is the pose of node b in node a.
Disagreement disagreement_of(const SeenMark& a, const SeenMark& b, const TPose2D& a_T_b,
                             const Matrix3d& covariance, Comparison comparison) {
  constexpr double kStep = 1e-6;            // of the numeric derivatives, metres or radians
  constexpr double kLeastVariance = 1e-12;  // m^2 or rad^2
  Poses poses;
  set(poses, 0, a_T_b);
  set(poses, 1, a.node_T_mark.pose);
  set(poses, 2, b.node_T_mark.pose);
  set(poses, 3, a.site_T_mark.pose);
  set(poses, 4, b.site_T_mark.pose);
  Eigen::Matrix<double, 3, 15> jacobian;
  for (int i = 0; i < 15; ++i) {
    Poses ahead = poses;
    Poses behind = poses;
    ahead[i] += kStep;
    behind[i] -= kStep;
    Vector3d step = disagreement(ahead, comparison) - disagreement(behind, comparison);
    step.z() = wrap_to_pi(step.z());
    jacobian.col(i) = step / (2 * kStep);
  }
  Eigen::Matrix<double, 12, 12> of_statements = Eigen::Matrix<double, 12, 12>::Zero();
  of_statements.block<3, 3>(0, 0) = covariance_of(a.node_T_mark);
  of_statements.block<3, 3>(3, 3) = covariance_of(b.node_T_mark);
  of_statements.block<3, 3>(6, 6) = covariance_of(a.site_T_mark);
  of_statements.block<3, 3>(9, 9) = covariance_of(b.site_T_mark);
  const Eigen::Matrix<double, 3, 3> by_graph = jacobian.leftCols<3>();
  const Eigen::Matrix<double, 3, 12> by_statements = jacobian.rightCols<12>();
  const Matrix3d drift = by_graph * covariance * by_graph.transpose();
  const Matrix3d statements = by_statements * of_statements * by_statements.transpose();
  const int size = dimensions(comparison);
  return {disagreement(poses, comparison).head(size), drift.topLeftCorner(size, size),
          statements.topLeftCorner(size, size) + kLeastVariance * MatrixXd::Identity(size, size)};
}

// Returns the covariance of the pose of node b in node a, plus the error of the scale of odometry. It is the
// same for the whole path, so the chain of path segments, a random walk, does not contain it.
Matrix3d with_scale_error(Matrix3d covariance, const TPose2D& a_T_b) {
  constexpr double kScaleSigma = 0.03;
  const double sigma_m = kScaleSigma * portable::hypot(a_T_b.x, a_T_b.y);
  covariance.topLeftCorner<2, 2>() += sigma_m * sigma_m * Eigen::Matrix2d::Identity();
  return covariance;
}

// Returns a consistent subset of `count` marks: drops the mark with the most conflicts, then the one with the
// largest conflicts, until no two marks are more than `max_chi` standard deviations apart. The disagreements
// are those of all pairs, in the order (0, 1), (0, 2), ... (1, 2), ...
std::vector<bool> consistent(std::size_t count, const std::vector<Disagreement>& disagreements,
                             double max_chi) {
  MatrixXd chi = MatrixXd::Zero(static_cast<Eigen::Index>(count), static_cast<Eigen::Index>(count));
  auto pair = disagreements.begin();
  for (Eigen::Index a = 0; a < chi.rows(); ++a)
    for (Eigen::Index b = a + 1; b < chi.rows() && pair != disagreements.end(); ++b, ++pair)
      chi(a, b) = chi(b, a) = std::sqrt(pair->chi2());
  std::vector<bool> kept(count, true);
  while (true) {
    std::pair<int, double> worst{0, 0.0};
    std::size_t dropped = count;
    for (std::size_t i = 0; i < count; ++i) {
      std::pair<int, double> conflicts{0, 0.0};
      for (std::size_t j = 0; j < count && kept[i]; ++j) {
        const double apart = chi(static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j));
        if (!kept[j] || apart <= max_chi) continue;
        ++conflicts.first;
        conflicts.second += apart;
      }
      if (conflicts.first == 0 || conflicts < worst) continue;
      worst = conflicts;
      dropped = i;
    }
    if (dropped == count) return kept;
    kept[dropped] = false;
  }
}

void enable(const std::vector<std::size_t>& constraints, const std::vector<bool>& enabled, PoseGraph& graph) {
  for (std::size_t i = 0; i < constraints.size(); ++i) graph.set_enabled(constraints[i], enabled[i]);
}

MeasuredPose relative_to(const TPose2D& site_T_root, MeasuredPose site_T_mark) {
  site_T_mark.pose = between(site_T_root, site_T_mark.pose);
  return site_T_mark;
}

KnownResidual residual_of(const Constraint& constraint, const PoseGraph& graph) {
  const Vector3d error = constraint_error(constraint.from_T_to, RotatedPose(graph.pose(constraint.from)),
                                          RotatedPose(graph.pose(constraint.to)));
  KnownResidual residual;
  residual.distance_m = error.head<2>().norm();
  if (constraint.information(2, 2) > 0) residual.turn_rad = std::abs(error.z());
  residual.chi = std::sqrt(std::max(0.0, error.dot(constraint.information * error)));
  return residual;
}

}  // namespace

// Compares marks by the poses of a graph and the honest covariances between them.
class KnownLandmarks::Consistency {
 public:
  explicit Consistency(const PoseGraph& graph) : graph_(graph) {
    try {
      covariances_.update(graph_with_shared_errors(graph));
      is_determined_ = true;
    } catch (const UserError&) {  // a constraint is singular, so nothing can be contradicted
    }
  }

  /// Returns the disagreements of all pairs of marks, as consistent() takes them. With `is_same`, all of them
  /// are one mark. Empty if the covariances are unknown.
  std::vector<Disagreement> of(const std::vector<SeenMark>& marks, bool is_same) const {
    std::vector<Disagreement> pairs;
    for (std::size_t a = 0; a + 1 < marks.size() && is_determined_; ++a) {
      const std::vector<Matrix3d> covariances = relative_to_later(marks, a);
      for (std::size_t b = a + 1; b < marks.size(); ++b) {
        const TPose2D a_T_b = between(graph_.pose(marks[a].node), graph_.pose(marks[b].node));
        pairs.push_back(disagreement_of(marks[a], marks[b], a_T_b,
                                        with_scale_error(covariances[b - a - 1], a_T_b),
                                        comparison_of(marks[a], marks[b], is_same)));
      }
    }
    return pairs;
  }

 private:
  static Comparison comparison_of(const SeenMark& a, const SeenMark& b, bool is_same) {
    if (a.has_heading() && b.has_heading()) return Comparison::kPose;
    if (is_same || a.has_heading()) return Comparison::kPositionFromA;
    return b.has_heading() ? Comparison::kPositionFromB : Comparison::kDistance;
  }

  // Covariances of the nodes of the marks after `a` relative to the node of `a`.
  std::vector<Matrix3d> relative_to_later(const std::vector<SeenMark>& marks, std::size_t a) const {
    std::vector<Matrix3d> covariances(marks.size() - a - 1, Matrix3d::Zero());
    std::map<std::size_t, std::vector<std::size_t>> by_node;
    for (std::size_t b = a + 1; b < marks.size(); ++b)
      if (marks[b].node != marks[a].node) by_node[marks[b].node].push_back(b - a - 1);
    std::vector<std::size_t> nodes;
    for (const auto& [node, indices] : by_node) nodes.push_back(node);
    const std::vector<Matrix3d> of_nodes = covariances_.relative(marks[a].node, nodes);
    auto of_node = of_nodes.begin();
    for (const auto& [node, indices] : by_node) {
      for (const std::size_t index : indices) covariances[index] = *of_node;
      ++of_node;
    }
    return covariances;
  }

  const PoseGraph& graph_;
  MarginalCovariance covariances_;
  bool is_determined_ = false;
};

KnownLandmarks::KnownLandmarks(std::vector<Landmark> landmarks, PoseGraph& graph)
    : landmarks_(std::move(landmarks)) {
  const auto add_node = [&] {
    const std::size_t node = graph.add_node({0, 0, 0});
    graph.add_constraint(weak_link(graph.root(), node));
    return node;
  };
  const auto first_placed = std::find_if(landmarks_.begin(), landmarks_.end(),
                                         [](const Landmark& one) { return one.site_T_mark.has_value(); });
  if (first_placed != landmarks_.end()) {
    site_T_root_ = {first_placed->site_T_mark->pose.x, first_placed->site_T_mark->pose.y, 0};
    site_ = add_node();
  }
  for (std::size_t i = 0; i < landmarks_.size(); ++i) numbers_.push_back({add_node(), {}, {}});
}

void KnownLandmarks::switch_off(PoseGraph& graph) const {
  for (const Numbers& numbers : numbers_) {
    if (numbers.place) graph.set_enabled(*numbers.place, false);
    for (const std::size_t sighting : numbers.sightings) graph.set_enabled(sighting, false);
  }
}

void KnownLandmarks::enable_sightings(std::size_t landmark, const std::vector<bool>& enabled,
                                      PoseGraph& graph) const {
  enable(numbers_[landmark].sightings, enabled, graph);
}

// Adds the constraints of all landmarks instead of those added before.
void KnownLandmarks::add_constraints(PoseGraph& graph) {
  switch_off(graph);
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    Numbers& numbers = numbers_[i];
    numbers.sightings.clear();
    for (std::size_t k = 0; k < landmarks_[i].sightings.size(); ++k) {
      const LandmarkSighting& sighting = landmarks_[i].sightings[k];
      numbers.sightings.push_back(
          graph.add_constraint(known_constraint(sighting.node, numbers.node, sighting.node_T_mark)));
    }
    if (landmarks_[i].site_T_mark)
      numbers.place = graph.add_constraint(
          known_constraint(*site_, numbers.node, relative_to(site_T_root_, *landmarks_[i].site_T_mark)));
  }
}

// Returns the best sighting of each landmark that has a place, and adds the numbers of these landmarks.
std::vector<SeenMark> KnownLandmarks::placed_marks(const PoseGraph& graph,
                                                   std::vector<std::size_t>& numbers) const {
  std::vector<SeenMark> marks;
  numbers.clear();
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (!landmarks_[i].site_T_mark) continue;
    const LandmarkSighting& best = landmarks_[i].sightings[best_sighting(i, graph)];
    marks.push_back({best.node, best.node_T_mark, relative_to(site_T_root_, *landmarks_[i].site_T_mark)});
    numbers.push_back(i);
  }
  return marks;
}

void KnownLandmarks::select(PoseGraph& graph, double max_chi) {
  switch_off(graph);
  const Consistency consistency(graph);
  std::vector<std::vector<Disagreement>> of_sightings;
  for (const Landmark& landmark : landmarks_) {
    std::vector<SeenMark> seen;
    for (const LandmarkSighting& sighting : landmark.sightings)
      seen.push_back({sighting.node, sighting.node_T_mark, {{0, 0, 0}, 0, 0}});
    of_sightings.push_back(consistency.of(seen, true));
  }
  add_constraints(graph);
  std::vector<std::size_t> placed;

  std::vector<std::vector<bool>> kept_sightings;
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    kept_sightings.push_back(consistent(landmarks_[i].sightings.size(), of_sightings[i], max_chi));
    enable_sightings(i, kept_sightings.back(), graph);
  }
  const std::vector<Disagreement> of_places = consistency.of(placed_marks(graph, placed), false);
  const std::vector<bool> kept_places = consistent(placed.size(), of_places, max_chi);
  for (std::size_t k = 0; k < placed.size(); ++k)
    graph.set_enabled(*numbers_[placed[k]].place, kept_places[k]);
  place_nodes(graph);
}

// Returns the most accurate sighting of a landmark that is switched on.
std::size_t KnownLandmarks::best_sighting(std::size_t landmark, const PoseGraph& graph) const {
  const std::vector<LandmarkSighting>& sightings = landmarks_[landmark].sightings;
  std::optional<std::size_t> best;
  for (std::size_t k = 0; k < sightings.size(); ++k) {
    const bool is_better = !best || sightings[k].node_T_mark.sigma_m < sightings[*best].node_T_mark.sigma_m;
    if (uses_sighting(landmark, k, graph) && is_better) best = k;
  }
  return best.value();  // at least one is consistent with itself
}

// Sets the poses of the landmarks' nodes by the poses of the nodes that saw them.
void KnownLandmarks::place_nodes(PoseGraph& graph) const {
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    const LandmarkSighting& best = landmarks_[i].sightings[best_sighting(i, graph)];
    graph.set_pose(numbers_[i].node, compose(graph.pose(best.node), best.node_T_mark.pose));
  }
  if (site_) graph.set_pose(*site_, placed_site(graph));
}

// Pose of the site's node by the landmarks whose places are switched on: from one with a heading, else from
// the rigid alignment of all positions.
TPose2D KnownLandmarks::placed_site(const PoseGraph& graph) const {
  Eigen::Vector2d in_map = Eigen::Vector2d::Zero();
  Eigen::Vector2d in_site = Eigen::Vector2d::Zero();
  std::vector<std::pair<TPose2D, TPose2D>> pairs;  // pose in the map, pose in the site
  for (std::size_t i = 0; i < landmarks_.size(); ++i) {
    if (!numbers_[i].place || !graph.enabled(*numbers_[i].place)) continue;
    const TPose2D& map_T_mark = graph.pose(numbers_[i].node);
    const MeasuredPose root_T_mark = relative_to(site_T_root_, *landmarks_[i].site_T_mark);
    const LandmarkSighting& best = landmarks_[i].sightings[best_sighting(i, graph)];
    if (root_T_mark.sigma_rad && best.node_T_mark.sigma_rad)
      return compose(map_T_mark, inverse(root_T_mark.pose));
    pairs.emplace_back(map_T_mark, root_T_mark.pose);
    in_map += Eigen::Vector2d(map_T_mark.x, map_T_mark.y);
    in_site += Eigen::Vector2d(root_T_mark.pose.x, root_T_mark.pose.y);
  }
  if (pairs.empty()) return {0, 0, 0};
  in_map /= static_cast<double>(pairs.size());
  in_site /= static_cast<double>(pairs.size());
  double cosine = 0;
  double sine = 0;
  for (const auto& [map, site] : pairs) {
    const Eigen::Vector2d q(map.x - in_map.x(), map.y - in_map.y());
    const Eigen::Vector2d p(site.x - in_site.x(), site.y - in_site.y());
    cosine += p.dot(q);
    sine += p.x() * q.y() - p.y() * q.x();
  }
  const TPose2D turned(0, 0, pairs.size() > 1 ? portable::atan2(sine, cosine) : 0);
  const TPose2D centre = compose(turned, TPose2D(in_site.x(), in_site.y(), 0));
  return {in_map.x() - centre.x, in_map.y() - centre.y, turned.phi};
}

void KnownLandmarks::move_to_site(PoseGraph& graph) const {
  if (!site_) return;
  const TPose2D site_T_map = compose(site_T_root_, inverse(graph.pose(*site_)));
  for (std::size_t node = 0; node < graph.num_nodes(); ++node)
    graph.set_pose(node, compose(site_T_map, graph.pose(node)));
  graph.set_pose(*site_, site_T_root_);
  graph.set_root(*site_);
}

bool KnownLandmarks::uses_place(std::size_t landmark, const PoseGraph& graph) const {
  return graph.enabled(numbers_.at(landmark).place.value());
}

bool KnownLandmarks::uses_sighting(std::size_t landmark, std::size_t sighting, const PoseGraph& graph) const {
  return graph.enabled(numbers_.at(landmark).sightings.at(sighting));
}

KnownResidual KnownLandmarks::place_residual(std::size_t landmark, const PoseGraph& graph) const {
  return residual_of(graph.constraint(numbers_.at(landmark).place.value()), graph);
}

KnownResidual KnownLandmarks::sighting_residual(std::size_t landmark, std::size_t sighting,
                                                const PoseGraph& graph) const {
  return residual_of(graph.constraint(numbers_.at(landmark).sightings.at(sighting)), graph);
}

}  // namespace psi_slam
