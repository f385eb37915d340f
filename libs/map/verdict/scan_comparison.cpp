// SPDX-License-Identifier: BSD-3-Clause
#include "map/verdict/scan_comparison.h"

#include <mrpt/math/wrap2pi.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "base/portable_math.h"
#include "logs/frames/pose_operations.h"

namespace psi_slam {
namespace {

using mrpt::math::TPoint2D;
using mrpt::math::TPose2D;

// Widths of the kernel of Geman and McClure in the steps of the alignment, metres.
constexpr std::array<double, 6> kKernels_m{0.5, 0.5, 0.3, 0.2, 0.1, 0.1};

/// Ranges of the nearest beam and of its neighbours on both sides.
struct BeamRanges {
  double nearest_m = 0;
  double shortest_m = 0;
};

/// The beams of a scan by bearing.
class BeamFan {
 public:
  explicit BeamFan(const LaserScan& scan)
      : bearings_(*scan.bearings_rad),
        ranges_(scan.ranges_m),
        sign_(bearings_.back() > bearings_.front() ? 1 : -1) {}

  /// Beams towards a bearing. Empty outside the field of view and unless three beams have returns.
  std::optional<BeamRanges> towards(double bearing_rad) const {
    const auto first = static_cast<double>(bearings_.front());
    const double from_first = mrpt::math::wrapTo2Pi(sign_ * (bearing_rad - first));
    const auto after =
        std::lower_bound(bearings_.begin(), bearings_.end(), from_first, [&](float bearing, double wanted) {
          return sign_ * (static_cast<double>(bearing) - first) < wanted;
        });
    if (after == bearings_.begin() || after == bearings_.end()) return std::nullopt;
    auto index = static_cast<std::size_t>(after - bearings_.begin());
    const auto angle = [&](std::size_t i) { return sign_ * (static_cast<double>(bearings_[i]) - first); };
    if (from_first - angle(index - 1) < angle(index) - from_first) --index;
    if (index == 0 || index + 1 >= bearings_.size()) return std::nullopt;
    BeamRanges beams{static_cast<double>(ranges_[index]), 0};
    const auto [low, high] = std::minmax({ranges_[index - 1], ranges_[index], ranges_[index + 1]});
    beams.shortest_m = static_cast<double>(low);
    if (!std::isfinite(ranges_[index - 1]) || !std::isfinite(ranges_[index]) ||
        !std::isfinite(ranges_[index + 1]) || high <= 0)
      return std::nullopt;
    return beams;
  }

 private:
  const std::vector<float>& bearings_;
  const std::vector<float>& ranges_;
  double sign_;
};

/// A surface point of the view in the frame of the other laser, and what the other laser saw there.
struct Sighting {
  Eigen::Vector2d point;
  Eigen::Vector2d normal;
  double offset_m = 0;  // along the normal, to the end of the nearest beam
  double behind_m = 0;  // depth of the free space behind the surface, along its normal
};

/// Compares the points at one pose after another.
class Comparison {
 public:
  Comparison(const MapView& view, const MapView& other, const ScanComparisonOptions& options)
      : view_(view), fan_(*other.scan), options_(options) {}

  std::vector<Sighting> sightings(const TPose2D& other_T_robot) const {
    const double c = portable::cos(other_T_robot.phi);
    const double s = portable::sin(other_T_robot.phi);
    std::vector<Sighting> seen;
    for (std::size_t i = 0; i < view_.surfaces.points.size(); ++i) {
      const auto px = static_cast<double>(view_.surfaces.points[i].x);
      const auto py = static_cast<double>(view_.surfaces.points[i].y);
      const auto nx = static_cast<double>(view_.surfaces.normals[i].x);
      const auto ny = static_cast<double>(view_.surfaces.normals[i].y);
      Sighting one;
      one.point = {c * px - s * py + other_T_robot.x, s * px + c * py + other_T_robot.y};
      one.normal = {c * nx - s * ny, s * nx + c * ny};
      const double range_m = one.point.norm();
      if (range_m < options_.margin_m || range_m > options_.max_range_m) continue;
      const double incidence = -one.normal.dot(one.point) / range_m;
      if (incidence < options_.least_incidence) continue;  // seen from behind, or at a grazing angle
      const std::optional<BeamRanges> beams = fan_.towards(portable::atan2(one.point.y(), one.point.x()));
      if (!beams) continue;
      one.offset_m = -(beams->nearest_m - range_m) * incidence;
      one.behind_m = (beams->shortest_m - range_m) * incidence;
      seen.push_back(one);
    }
    return seen;
  }

  bool is_same(const Sighting& one) const { return std::abs(one.offset_m) <= options_.margin_m; }
  bool is_seen_through(const Sighting& one) const { return one.behind_m > options_.margin_m; }

  /// Pose after one step of the alignment: points move onto the ends of the beams, along their normals.
  TPose2D step(const TPose2D& other_T_robot, double kernel_m, const TPose2D& start) const {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    Eigen::Vector3d gradient = Eigen::Vector3d::Zero();
    const Eigen::Vector2d middle(other_T_robot.x, other_T_robot.y);
    for (const Sighting& one : sightings(other_T_robot)) {
      if (std::abs(one.offset_m) > options_.max_offset_m) continue;
      const double share = one.offset_m / kernel_m;
      const double weight = 1 / ((1 + share * share) * (1 + share * share));
      const Eigen::Vector2d arm = one.point - middle;
      const Eigen::Vector3d jacobian(one.normal.x(), one.normal.y(),
                                     arm.x() * one.normal.y() - arm.y() * one.normal.x());
      information += weight * jacobian * jacobian.transpose();
      gradient += weight * one.offset_m * jacobian;
    }
    information += kPriorPoints * Eigen::Matrix3d::Identity();
    const TPose2D back = between(other_T_robot, start);
    const double c = portable::cos(other_T_robot.phi);
    const double s = portable::sin(other_T_robot.phi);
    gradient += kPriorPoints * Eigen::Vector3d(c * back.x - s * back.y, s * back.x + c * back.y, back.phi);
    const Eigen::Vector3d move = information.ldlt().solve(gradient);
    return {other_T_robot.x + move.x(), other_T_robot.y + move.y(),
            mrpt::math::wrapToPi(other_T_robot.phi + move.z())};
  }

 private:
  const MapView& view_;
  BeamFan fan_;
  const ScanComparisonOptions& options_;
};

/// Returns whether more points see the same wall than not, in each direction that they face. A direction that
/// hardly any point faces is open, and a displacement along it changes nothing.
bool is_held(const Comparison& comparison, const std::vector<Sighting>& seen) {
  Eigen::Matrix2d balance = Eigen::Matrix2d::Zero();
  for (const Sighting& one : seen)
    balance += (comparison.is_same(one) ? 1 : -1) * one.normal * one.normal.transpose();
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d>(balance, Eigen::EigenvaluesOnly).eigenvalues().x() >
         kPriorPoints;
}

/// Returns a point in the middle of the seen-through or doubled walls, in the frame of the other laser.
std::optional<Eigen::Vector2d> middle_of_faults(const Comparison& comparison,
                                                const std::vector<Sighting>& seen) {
  std::vector<Eigen::Vector2d> faults;
  Eigen::Vector2d sum(0, 0);
  for (const Sighting& one : seen) {
    if (comparison.is_same(one)) continue;
    faults.push_back(one.point);
    sum += one.point;
  }
  if (faults.empty()) return std::nullopt;
  const Eigen::Vector2d mean = sum / static_cast<double>(faults.size());
  return *std::min_element(faults.begin(), faults.end(), [&](const auto& a, const auto& b) {
    return (a - mean).squaredNorm() < (b - mean).squaredNorm();
  });
}

}  // namespace

ScanComparison compare_scans(const MapView& view, const MapView& other,
                             const ScanComparisonOptions& options) {
  const Comparison comparison(view, other, options);
  const TPose2D start = between(other.map_T_laser(), view.map_T_robot);
  const std::vector<Sighting> seen = comparison.sightings(start);
  ScanComparison result;
  result.points = seen.size();
  std::vector<double> offsets_m;
  for (const Sighting& one : seen) {
    result.same += comparison.is_same(one) ? 1 : 0;
    result.seen_through += !comparison.is_same(one) && comparison.is_seen_through(one) ? 1 : 0;
    if (std::abs(one.offset_m) <= options.max_offset_m) offsets_m.push_back(std::abs(one.offset_m));
  }
  if (!offsets_m.empty()) {
    const auto middle = offsets_m.begin() + static_cast<std::ptrdiff_t>(offsets_m.size() / 2);
    std::nth_element(offsets_m.begin(), middle, offsets_m.end());
    result.offset_m = *middle;
  }
  result.is_held = is_held(comparison, seen);
  const Eigen::Vector2d at = middle_of_faults(comparison, seen).value_or(Eigen::Vector2d(start.x, start.y));
  const TPose2D placed = compose(other.map_T_laser(), TPose2D(at.x(), at.y(), 0));
  result.at = {placed.x, placed.y};

  TPose2D moved = start;
  for (const double kernel_m : kKernels_m) moved = comparison.step(moved, kernel_m, start);
  result.displacement_m = distance_m(start, moved);
  result.map_T_moved = compose(other.map_T_laser(), moved);
  result.turn_rad = std::abs(mrpt::math::wrapToPi(moved.phi - start.phi));
  std::size_t same = 0;
  std::size_t through = 0;
  for (const Sighting& one : comparison.sightings(moved)) {
    same += comparison.is_same(one) ? 1 : 0;
    through += !comparison.is_same(one) && comparison.is_seen_through(one) ? 1 : 0;
  }
  result.compared_if_moved = same + through;
  result.same_if_moved =
      same + through == 0 ? 0 : static_cast<double>(same) / static_cast<double>(same + through);
  return result;
}

}  // namespace psi_slam
