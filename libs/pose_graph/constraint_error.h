// SPDX-License-Identifier: BSD-3-Clause
// Error of one constraint, equations 5 and 6: e = z - f(x_i, x_j) with
// f = [R_i^T (t_j - t_i); theta_j - theta_i], the angle wrapped to (-pi, pi]. e is in the axes of node i.
#pragma once

#include <mrpt/math/TPose2D.h>

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "base/portable_math.h"

namespace psi_slam {

/// Returns the angle wrapped to (-pi, pi], in radians. Does not change an angle in this range;
/// mrpt::math::wrapToPi adds and subtracts pi, which rounds small angles.
inline double wrap_to_pi(double angle) {
  if (angle > -M_PI && angle <= M_PI) return angle;
  const double wrapped = std::remainder(angle, 2 * M_PI);
  return wrapped > -M_PI ? wrapped : M_PI;
}

/// A pose with the sine and cosine of its heading, computed once for the many constraints of a node.
struct RotatedPose {
  double x = 0, y = 0, theta = 0;
  double cosine = 1, sine = 0;

  RotatedPose() = default;
  explicit RotatedPose(const mrpt::math::TPose2D& pose)
      : x(pose.x),
        y(pose.y),
        theta(pose.phi),
        cosine(portable::cos(pose.phi)),
        sine(portable::sin(pose.phi)) {}
};

inline std::vector<RotatedPose> rotated(const std::vector<mrpt::math::TPose2D>& poses) {
  return std::vector<RotatedPose>(poses.begin(), poses.end());
}

/// Returns e(x_i, x_j) for the measurement z = i_T_j: metres, metres, radians.
inline Eigen::Vector3d constraint_error(const mrpt::math::TPose2D& i_T_j, const RotatedPose& map_T_i,
                                        const RotatedPose& map_T_j) {
  const double dx = map_T_j.x - map_T_i.x;
  const double dy = map_T_j.y - map_T_i.y;
  return {i_T_j.x - (map_T_i.cosine * dx + map_T_i.sine * dy),
          i_T_j.y - (map_T_i.cosine * dy - map_T_i.sine * dx),
          wrap_to_pi(i_T_j.phi - (map_T_j.theta - map_T_i.theta))};
}

/// Jacobians de/dx_i and de/dx_j, where x = (x, y, theta) is the pose of each node in the map frame.
struct ConstraintJacobians {
  Eigen::Matrix3d wrt_i;
  Eigen::Matrix3d wrt_j;
};

inline ConstraintJacobians constraint_jacobians(const RotatedPose& map_T_i, const RotatedPose& map_T_j) {
  const double c = map_T_i.cosine;
  const double s = map_T_i.sine;
  const double dx = map_T_j.x - map_T_i.x;
  const double dy = map_T_j.y - map_T_i.y;
  ConstraintJacobians jacobians;
  jacobians.wrt_i << c, s, s * dx - c * dy,  //
      -s, c, c * dx + s * dy,                //
      0, 0, 1;
  jacobians.wrt_j << -c, -s, 0,  //
      s, -c, 0,                  //
      0, 0, -1;
  return jacobians;
}

/// Parts of H = J^T Omega J and g = J^T Omega e that one constraint adds to the normal equations H dx = -g of
/// equation 6.
struct ConstraintNormals {
  Eigen::Matrix3d ii;  ///< block (i, i) of H
  Eigen::Matrix3d ij;  ///< block (i, j) of H
  Eigen::Matrix3d jj;  ///< block (j, j) of H
  Eigen::Vector3d i;   ///< block i of g
  Eigen::Vector3d j;   ///< block j of g
};

/// Returns the terms of one constraint, with a fraction of the work of multiplying constraint_jacobians().
/// With R = diag(R_i, 1) and U = I + [0 0 -dy; 0 0 dx; 0 0 0], the Jacobians are R^T U and -R^T. With W = R
/// Omega R^T, H_jj = W, H_ij = -U^T W, H_ii = U^T W U, g_j = -R Omega e and g_i = -U^T g_j.
inline ConstraintNormals constraint_normals(const Eigen::Matrix3d& information, const Eigen::Vector3d& error,
                                            const RotatedPose& map_T_i, const RotatedPose& map_T_j) {
  const double c = map_T_i.cosine;
  const double s = map_T_i.sine;
  const double dx = map_T_j.x - map_T_i.x;
  const double dy = map_T_j.y - map_T_i.y;
  const double a = information(0, 0);
  const double b = information(0, 1);
  const double d = information(1, 1);
  const double off = s * c * (a - d);
  const double w00 = c * c * a - 2 * s * c * b + s * s * d;
  const double w01 = off + (c * c - s * s) * b;
  const double w11 = s * s * a + 2 * s * c * b + c * c * d;
  const double w02 = c * information(0, 2) - s * information(1, 2);
  const double w12 = s * information(0, 2) + c * information(1, 2);
  const double w22 = information(2, 2);

  ConstraintNormals normals;
  normals.jj << w00, w01, w02,  //
      w01, w11, w12,            //
      w02, w12, w22;
  const double u0 = -dy * w00 + dx * w01 + w02;  // the last row of U^T W
  const double u1 = -dy * w01 + dx * w11 + w12;
  const double u2 = -dy * w02 + dx * w12 + w22;
  normals.ij << -w00, -w01, -w02,  //
      -w01, -w11, -w12,            //
      -u0, -u1, -u2;
  normals.ii << w00, w01, u0,  //
      w01, w11, u1,            //
      u0, u1, -dy * u0 + dx * u1 + u2;
  const Eigen::Vector3d weighted = information * error;
  const double gx = c * weighted.x() - s * weighted.y();
  const double gy = s * weighted.x() + c * weighted.y();
  normals.j << -gx, -gy, -weighted.z();
  normals.i << gx, gy, -dy * gx + dx * gy + weighted.z();
  return normals;
}

}  // namespace psi_slam
