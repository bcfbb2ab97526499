// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/icp.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/sampling.h"

namespace axial::geometry {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Matrix6d = Eigen::Matrix<double, 6, 6>;

struct Pair {
  Eigen::Vector3d point;
  Eigen::Vector3d normal;  // gradient of the distance at the point
  double distance;
};

std::vector<Pair> find_pairs(std::span<const Eigen::Vector3f> points, const Surface& surface,
                             const Similarity& transform) {
  std::vector<Pair> pairs(points.size());
  parallel_for(
      points.size(),
      [&](std::size_t i) {
        const Eigen::Vector3d x = transform(points[i].cast<double>());
        const ClosestPoint closest = surface.closest(x);
        // On the surface itself the sign of the gradient is undefined. Either sign holds the point
        // in the plane.
        const Eigen::Vector3d normal = closest.distance > 1e-12
                                           ? Eigen::Vector3d((x - closest.point) / closest.distance)
                                           : surface.face_normal(closest.face);
        pairs[i] = {x, normal, closest.distance};
      },
      1024);
  return pairs;
}

double median_distance(const std::vector<Pair>& pairs) {
  std::vector<double> distances;
  distances.reserve(pairs.size());
  for (const Pair& pair : pairs) distances.push_back(pair.distance);
  return upper_median(std::move(distances));
}

struct Extent {
  Eigen::Vector3d centre;
  double radius;  // root mean square of the distances to the centre [m]
};

Extent extent_of(std::span<const Eigen::Vector3f> points) {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  for (const auto& x : points) centre += x.cast<double>();
  centre /= static_cast<double>(points.size());
  double sum = 0;
  for (const auto& x : points) sum += (x.cast<double>() - centre).squaredNorm();
  return {centre, std::sqrt(sum / static_cast<double>(points.size()))};
}

// Returns the step (rotation vector times radius, translation) that minimises the squared distances
// of the pairs. The step is zero along directions that the pairs do not constrain.
Vector6d solve_step(const std::vector<Pair>& pairs, const Eigen::Vector3d& centre, double radius,
                    double limit) {
  Matrix6d normal_matrix = Matrix6d::Zero();
  Vector6d right_side = Vector6d::Zero();
  for (const Pair& pair : pairs) {
    if (pair.distance > limit) continue;
    Vector6d row;
    row << ((pair.point - centre) / radius).cross(pair.normal), pair.normal;
    normal_matrix += row * row.transpose();
    right_side -= row * pair.distance;
  }
  const EigenPairs eigen = symmetric_eigen(normal_matrix);
  const double least = 1e-6 * eigen.values[5];
  Vector6d step = Vector6d::Zero();
  for (int k = 0; k < 6; ++k) {
    const Vector6d direction = eigen.vectors.col(k);
    if (eigen.values[k] > least) step += direction * (direction.dot(right_side) / eigen.values[k]);
  }
  return step;
}

}  // namespace

IcpResult refine_rigid(std::span<const Eigen::Vector3f> points, const Surface& surface,
                       const IcpOptions& options) {
  if (points.size() < 6)
    fail("{} points are too few to align a cloud, at least 6 are needed", points.size());
  const auto sampled = subsample(points, options.samples, options.seed);
  const Extent extent = extent_of(sampled);
  if (!std::isfinite(extent.radius) || !(extent.radius > 0))
    fail("the cloud has no extent to align by");

  IcpResult result;
  std::vector<Pair> pairs = find_pairs(sampled, surface, result.transform);
  result.median_before = median_distance(pairs);
  while (result.iterations < options.max_iterations && !result.converged) {
    const double limit = std::max(options.trim * median_distance(pairs), 1e-9 * extent.radius);
    const Eigen::Vector3d centre = result.transform(extent.centre);
    const Vector6d step = solve_step(pairs, centre, extent.radius, limit);
    const Eigen::Vector3d turn = step.head<3>() / extent.radius;
    Similarity move;
    if (turn.norm() > 0)
      move.rotation = Eigen::AngleAxisd(turn.norm(), turn.normalized()).toRotationMatrix();
    move.translation = centre - move.rotation * centre + step.tail<3>();
    result.transform = move.after(result.transform);
    pairs = find_pairs(sampled, surface, result.transform);
    ++result.iterations;
    result.converged = step.norm() < options.stop * extent.radius;
  }
  result.median_after = median_distance(pairs);
  return result;
}

}  // namespace axial::geometry
