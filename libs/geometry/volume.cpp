// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/volume.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/hash.h"
#include "geometry/convex_part.h"
#include "geometry/faces.h"
#include "geometry/sampling.h"
#include "scene/decompositions.h"

namespace axial::geometry {
namespace {

using Points = std::vector<Eigen::Vector3d>;

constexpr std::size_t kSamples = 20000;
constexpr std::size_t kTrials = 1000;
constexpr double kLeastAlong = std::numbers::sqrt2 / 2;  // cosine of 45 degrees

bool is_upright(const Plane& plane, const GroundOptions& options) {
  return std::abs(plane.normal(options.up_axis)) >= kLeastAlong;
}

bool within(const Plane& plane, const Eigen::Vector3d& x, double threshold) {
  return std::abs(plane.height_of(x)) <= threshold;
}

// The plane through three random samples, if it has the wanted direction.
std::optional<Plane> random_plane(const Points& samples, std::size_t trial,
                                  const GroundOptions& options) {
  const auto pick = [&](std::uint64_t k) -> const Eigen::Vector3d& {
    const std::uint64_t bits = scramble(scramble(scramble(options.seed) ^ trial) + k);
    return samples[bits % samples.size()];
  };
  const Eigen::Vector3d& a = pick(0);
  const Eigen::Vector3d normal = (pick(1) - a).cross(pick(2) - a);
  if (!(normal.norm() > 0)) return {};
  Plane plane{normal.normalized(), 0};
  if (!is_upright(plane, options)) return {};
  plane.offset = plane.normal.dot(a);
  return plane;
}

// The least-squares plane of the samples within the threshold of `plane`.
Plane fitted(const Points& samples, const Plane& plane, double threshold) {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  std::size_t count = 0;
  for (const Eigen::Vector3d& x : samples)
    if (within(plane, x, threshold)) {
      mean += x;
      ++count;
    }
  if (count < 3) return plane;
  mean /= static_cast<double>(count);
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (const Eigen::Vector3d& x : samples)
    if (within(plane, x, threshold)) moments += (x - mean) * (x - mean).transpose();
  const SymmetricEigen3 eigen(moments);
  const Eigen::Vector3d normal = eigen.eigenvectors().col(0);
  return {normal, normal.dot(mean)};
}

double diagonal(const Mesh& mesh) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& x : mesh.vertices) box.extend(x);
  return static_cast<double>(box.diagonal().norm());
}

std::optional<Plane> best_plane(const Points& samples, double threshold,
                                const GroundOptions& options) {
  std::optional<Plane> best;
  std::ptrdiff_t most = 0;
  for (std::size_t trial = 0; trial < kTrials; ++trial) {
    const auto plane = random_plane(samples, trial, options);
    if (!plane) continue;
    const std::ptrdiff_t count = std::ranges::count_if(
        samples, [&](const Eigen::Vector3d& x) { return within(*plane, x, threshold); });
    if (count <= most) continue;
    most = count;
    best = plane;
  }
  return best;
}

// Twice the area of the projection of a triangle onto the plane, times three times its mean height.
double six_volumes(const Plane& plane, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                   const Eigen::Vector3d& c) {
  const double area2 = plane.normal.dot((b - a).cross(c - a));
  return area2 * (plane.height_of(a) + plane.height_of(b) + plane.height_of(c));
}

}  // namespace

Plane ground_plane(const Mesh& mesh, const Eigen::Vector3d& above, const GroundOptions& options) {
  Points samples;
  for (const Eigen::Vector3f& x : sample_surface(mesh, kSamples, options.seed))
    samples.push_back(x.cast<double>());
  const double threshold = options.threshold > 0 ? options.threshold : diagonal(mesh) / 200;
  const auto found = best_plane(samples, threshold, options);
  if (!found) fail("no ground plane is within 45 degrees of the up axis {}", options.up_axis);
  Plane plane = *found;
  for (int step = 0; step < 3; ++step) {
    const Plane refined = fitted(samples, plane, threshold);
    if (!is_upright(refined, options)) break;
    plane = refined;
  }
  if (plane.height_of(above) < 0) plane = {-plane.normal, -plane.offset};
  return plane;
}

double volume_above(const Mesh& mesh, const Plane& plane) {
  double sum = 0;
  Points part;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    convex_part(
        corners_of(mesh, f), [&](const auto& x) { return plane.height_of(x); }, part);
    for (std::size_t k = 2; k < part.size(); ++k)
      sum += six_volumes(plane, part[0], part[k - 1], part[k]);
  }
  return sum / 6;
}

double enclosed_volume(const Mesh& mesh) {
  if (mesh.vertices.empty()) return 0;
  // Heights above a plane near the mesh are small, and so is their rounding error.
  Plane plane;
  plane.offset = plane.normal.dot(mesh.vertices.front().cast<double>());
  double sum = 0;
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const auto [a, b, c] = corners_of(mesh, f);
    sum += six_volumes(plane, a, b, c);
  }
  return sum / 6;
}

}  // namespace axial::geometry
