// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/registration/p3p.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <optional>

#include "pose/bundle/observation_cost.h"

namespace axial::pose {
namespace {

using Vector5d = Eigen::Matrix<double, 5, 1>;
using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

// The real roots of coefficients(0) + coefficients(1) x + ... + coefficients(4) x^4.
std::vector<double> real_roots(const Vector5d& coefficients) {
  constexpr double kLeastLeading = 1e-12, kMostImaginary = 1e-4;
  const double size = coefficients.lpNorm<Eigen::Infinity>();
  if (!(std::abs(coefficients(4)) > kLeastLeading * size)) return {};
  Eigen::Matrix4d companion = Eigen::Matrix4d::Zero();
  companion.bottomLeftCorner<3, 3>().setIdentity();
  companion.col(3) = -coefficients.head<4>() / coefficients(4);
  const Eigen::EigenSolver<Eigen::Matrix4d> solver(companion, false);
  std::vector<double> roots;
  if (solver.info() != Eigen::Success) return roots;
  // A double root comes as two roots near the real axis. Newton's method improves them.
  for (const auto& root : solver.eigenvalues())
    if (std::abs(root.imag()) <= kMostImaginary * (1 + std::abs(root.real())))
      roots.push_back(root.real());
  return roots;
}

// The pose that maps the triangle of `points` [world] to the triangle `seen` [camera frame] of the
// same shape.
Pose pose_between(const ThreeVectors& points, const ThreeVectors& seen) {
  const auto frame = [](const ThreeVectors& corners) {
    Eigen::Matrix3d axes;
    axes.col(0) = (corners[1] - corners[0]).normalized();
    axes.col(2) = axes.col(0).cross(corners[2] - corners[0]).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    return axes;
  };
  Pose pose;
  pose.rotation = frame(seen) * frame(points).transpose();
  const Eigen::Vector3d from = (points[0] + points[1] + points[2]) / 3;
  const Eigen::Vector3d to = (seen[0] + seen[1] + seen[2]) / 3;
  pose.centre = from - pose.rotation.transpose() * to;
  return pose;
}

// Haralick's numbers: the cosines of the angles between the bearings opposite to the sides a, b
// and c, and the ratios of the squared sides.
struct Triangle {
  double cos_a, cos_b, cos_c;
  double difference;  // (a^2 - c^2) / b^2
  double sum;         // (a^2 + c^2) / b^2
  double a2, c2;      // a^2 / b^2 and c^2 / b^2
  double b;           // the side b
};

Triangle triangle_of(const ThreeVectors& bearings, const ThreeVectors& points) {
  Triangle t{};
  t.cos_a = bearings[1].dot(bearings[2]);
  t.cos_b = bearings[0].dot(bearings[2]);
  t.cos_c = bearings[0].dot(bearings[1]);
  t.b = (points[0] - points[2]).norm();
  t.a2 = (points[1] - points[2]).squaredNorm() / (t.b * t.b);
  t.c2 = (points[0] - points[1]).squaredNorm() / (t.b * t.b);
  t.difference = t.a2 - t.c2;
  t.sum = t.a2 + t.c2;
  return t;
}

// The quartic whose roots are the ratios of the third to the first distance.
Vector5d quartic_of(const Triangle& t) {
  const double d = t.difference, ca = t.cos_a, cb = t.cos_b, cc = t.cos_c;
  Vector5d k;
  k(4) = (d - 1) * (d - 1) - 4 * t.c2 * ca * ca;
  k(3) = 4 * (d * (1 - d) * cb - (1 - t.sum) * ca * cc + 2 * t.c2 * ca * ca * cb);
  k(2) = 2 * (d * d - 1 + 2 * d * d * cb * cb + 2 * (1 - t.c2) * ca * ca -
              4 * t.sum * ca * cb * cc + 2 * (1 - t.a2) * cc * cc);
  k(1) = 4 * (-d * (1 + d) * cb + 2 * t.a2 * cc * cc * cb - (1 - t.sum) * ca * cc);
  k(0) = (1 + d) * (1 + d) - 4 * t.a2 * cc * cc;
  return k;
}

// The distances of the three points for a root of the quartic. Empty if one is not positive.
std::optional<Eigen::Vector3d> distances_of(const Triangle& t, double root) {
  const double d = t.difference;
  const double ratio =
      ((d - 1) * root * root - 2 * d * t.cos_b * root + 1 + d) / (2 * (t.cos_c - root * t.cos_a));
  const double first = t.b / std::sqrt(1 + root * root - 2 * root * t.cos_b);
  if (!(root > 0 && ratio > 0 && std::isfinite(ratio) && std::isfinite(first))) return {};
  return Eigen::Vector3d(first, ratio * first, root * first);
}

bool lie_on_a_line(const ThreeVectors& points) {
  constexpr double kLeastSine = 1e-3;
  const Eigen::Vector3d one = points[1] - points[0], other = points[2] - points[0];
  return !(one.cross(other).norm() > kLeastSine * one.norm() * other.norm());
}

// How far the points lie beside their rays, as tangents of angles, and the derivative of these
// numbers by the PoseNumbers (observation_cost.h) of `pose`.
struct Misses {
  Vector6d values;
  Matrix6d by_pose;
  bool in_front = true;  // all points
};

Misses misses_of(const ThreeRays& rays, const ThreeVectors& points, const Pose& pose) {
  Misses misses;
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d X = pose.to_camera(points[i]);
    const Eigen::Vector3d from_origin = X - rays[i].origin;
    const double depth = rays[i].direction.dot(from_origin);
    misses.in_front = misses.in_front && depth > 0;
    Eigen::Matrix<double, 2, 3> across;
    across.row(0) = rays[i].direction.unitOrthogonal().transpose();
    across.row(1) = rays[i].direction.cross(across.row(0).transpose()).transpose();
    const Eigen::Vector2d beside = across * from_origin / depth;
    const Eigen::Matrix<double, 2, 3> by_point =
        (across - beside * rays[i].direction.transpose()) / depth;
    const auto row = static_cast<Eigen::Index>(2 * i);
    misses.values.segment<2>(row) = beside;
    misses.by_pose.block<2, 3>(row, 0) = -by_point * cross_matrix(X);
    misses.by_pose.block<2, 3>(row, 3) = -by_point * pose.rotation;
  }
  return misses;
}

// The pose near `pose` at which the points lie on their rays.
std::optional<Pose> improved(Pose pose, const ThreeRays& rays, const ThreeVectors& points) {
  constexpr int kSteps = 10;
  constexpr double kHit = 1e-7;  // tangent of an angle: less than a thousandth of a pixel
  for (int step = 0; step < kSteps; ++step) {
    const Misses misses = misses_of(rays, points, pose);
    if (!misses.in_front || !misses.values.allFinite()) return {};
    if (misses.values.lpNorm<Eigen::Infinity>() < kHit) return pose;
    const Vector6d change = misses.by_pose.partialPivLu().solve(-misses.values);
    if (!change.allFinite()) return {};
    PoseNumbers numbers = numbers_of(pose);
    for (std::size_t k = 0; k < numbers.size(); ++k)
      numbers[k] += change(static_cast<Eigen::Index>(k));
    pose = pose_with(pose, numbers);
  }
  return {};
}

}  // namespace

std::vector<Pose> p3p(const ThreeVectors& bearings, const ThreeVectors& points) {
  if (lie_on_a_line(points)) return {};
  const Triangle triangle = triangle_of(bearings, points);
  std::vector<Pose> poses;
  for (const double root : real_roots(quartic_of(triangle))) {
    const auto distances = distances_of(triangle, root);
    if (!distances) continue;
    ThreeVectors seen;
    for (std::size_t i = 0; i < 3; ++i)
      seen[i] = (*distances)(static_cast<Eigen::Index>(i)) * bearings[i];
    if (!lie_on_a_line(seen)) poses.push_back(pose_between(points, seen));
  }
  return poses;
}

std::vector<Pose> poses_of_three(const ThreeRays& rays, const ThreeVectors& points,
                                 double distance) {
  const Eigen::Vector3d middle = (rays[0].origin + rays[1].origin + rays[2].origin) / 3;
  ThreeVectors bearings;
  for (std::size_t i = 0; i < 3; ++i) bearings[i] = (rays[i].at(distance) - middle).normalized();
  std::vector<Pose> poses;
  for (Pose pose : p3p(bearings, points)) {
    pose.centre -= pose.rotation.transpose() * middle;  // from the middle to the camera centre
    if (const auto exact = improved(pose, rays, points)) poses.push_back(*exact);
  }
  return poses;
}

}  // namespace axial::pose
