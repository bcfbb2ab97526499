// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/registration/absolute_pose.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "base/error.h"
#include "base/hash.h"
#include "base/order_statistics.h"
#include "pose/adjust/adjust.h"
#include "pose/bundle/adjust_options.h"
#include "pose/bundle/observation_cost.h"
#include "pose/registration/p3p.h"
#include "scene/decompositions.h"

namespace axial::pose {
namespace {

using Ray = refractive::AxialRay<double>;

constexpr std::size_t kMostSamples = 3000, kLeastSamples = 100;
constexpr double kConfidence = 0.9999;  // that a sample without wrong sightings is among them
constexpr int kMostRounds = 6;          // of least squares

// A sighting with the ray of its pixel.
struct Sight {
  std::size_t index;  // of the sighting
  Ray ray;            // camera frame
  Eigen::Vector3d point;
  double allowed;  // largest angle between the ray and the direction to the point [rad]
};

// The change of the direction of a ray by one pixel [rad]; NaN if the pixel has no neighbour with a
// ray.
double angle_of_pixel(const PhotographCamera& camera, const Eigen::Vector2d& pixel,
                      const Ray& ray) {
  for (const double step : {1.0, -1.0}) {
    const double angle =
        (camera.ray(pixel + Eigen::Vector2d(step, 0)).direction - ray.direction).norm();
    if (std::isfinite(angle)) return angle;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

std::vector<Sight> sights_of(const PhotographCamera& camera, std::span<const Sighting> sightings,
                             double max_error) {
  std::vector<Sight> sights;
  for (std::size_t i = 0; i < sightings.size(); ++i) {
    const Ray ray = camera.ray(sightings[i].pixel);
    if (!ray.direction.allFinite()) continue;
    const double allowed = max_error * angle_of_pixel(camera, sightings[i].pixel, ray);
    if (std::isfinite(allowed)) sights.push_back({i, ray, sightings[i].point, allowed});
  }
  return sights;
}

// How badly a pose fits: the sum of the squared errors, in units of the allowed errors. Larger
// errors count 1.
struct Score {
  double cost = std::numeric_limits<double>::infinity();
  std::size_t inliers = 0;
};

Score score_of(const Pose& pose, const std::vector<Sight>& sights) {
  Score score{0, 0};
  for (const Sight& sight : sights) {
    const Eigen::Vector3d v = pose.to_camera(sight.point) - sight.ray.origin;
    const double sine2 = sight.ray.direction.cross(v).squaredNorm();
    const double error2 = sine2 / (v.squaredNorm() * sight.allowed * sight.allowed);
    const bool agrees = sight.ray.direction.dot(v) > 0 && error2 < 1;
    score.cost += agrees ? error2 : 1;
    score.inliers += agrees;
  }
  return score;
}

// Three different indices below `count`.
std::array<std::size_t, 3> sample(std::size_t count, std::uint64_t random) {
  std::array<std::size_t, 3> chosen{};
  for (std::size_t k = 0; k < 3; ++k) {
    do {
      random = scramble(random);
      chosen[k] = random % count;
    } while (std::find(chosen.begin(), chosen.begin() + static_cast<std::ptrdiff_t>(k),
                       chosen[k]) != chosen.begin() + static_cast<std::ptrdiff_t>(k));
  }
  return chosen;
}

// The samples after which one without wrong sightings is among them, if the share `right` of the
// sightings is right.
std::size_t samples_needed(double right) {
  const double all_right = right * right * right;
  if (all_right >= 1) return kLeastSamples;
  const double needed = std::log(1 - kConfidence) / std::log1p(-all_right);
  return static_cast<std::size_t>(std::clamp(needed, double{kLeastSamples}, double{kMostSamples}));
}

std::optional<Pose> best_of_samples(const std::vector<Sight>& sights,
                                    const AbsolutePoseOptions& options) {
  std::optional<Pose> best;
  Score least;
  std::size_t samples = kMostSamples;
  for (std::size_t i = 0; i < samples; ++i) {
    const auto chosen = sample(sights.size(), scramble(options.seed) + i);
    ThreeRays rays;
    ThreeVectors points;
    for (std::size_t k = 0; k < 3; ++k) {
      rays[k] = sights[chosen[k]].ray;
      points[k] = sights[chosen[k]].point;
    }
    for (const Pose& pose : poses_of_three(rays, points, options.distance)) {
      const Score score = score_of(pose, sights);
      if (!(score.cost < least.cost)) continue;
      least = score;
      best = pose;
      samples =
          samples_needed(static_cast<double>(score.inliers) / static_cast<double>(sights.size()));
    }
  }
  return best;
}

std::vector<std::size_t> inliers_of(const PhotographCamera& camera, const Pose& pose,
                                    std::span<const Sighting> sightings, double max_error) {
  std::vector<std::size_t> inliers;
  for (std::size_t i = 0; i < sightings.size(); ++i)
    if (reprojection_error(camera, pose, sightings[i].point, sightings[i].pixel) <= max_error)
      inliers.push_back(i);
  return inliers;
}

// The pose with the smallest errors of the sightings `chosen`, near `pose`.
Pose adjusted(const BundleCamera& camera, const Pose& pose, std::span<const Sighting> sightings,
              std::span<const std::size_t> chosen) {
  Bundle one;
  one.cameras = {camera};
  one.images = {{"", 0, pose}};
  for (const std::size_t i : chosen) {
    one.observations.push_back({0, one.points.size(), sightings[i].pixel, i});
    one.points.push_back({sightings[i].point, i});
  }
  AdjustOptions options;
  options.points_known = true;
  options.max_iterations = 30;
  adjust(one, options);
  return one.images[0].pose;
}

}  // namespace

AbsolutePose absolute_pose(const BundleCamera& camera, std::span<const Sighting> sightings,
                           const AbsolutePoseOptions& options) {
  constexpr std::size_t kLeastSightings = 4;  // three have up to four poses
  const PhotographCamera now(camera.now());
  const std::vector<Sight> sights = sights_of(now, sightings, options.max_error);
  if (sights.size() < kLeastSightings) return {};
  const std::optional<Pose> start = best_of_samples(sights, options);
  if (!start) return {};
  AbsolutePose found{*start, inliers_of(now, *start, sightings, options.max_error)};
  for (int round = 0; round < kMostRounds && found.inliers.size() >= kLeastSightings; ++round) {
    const Pose pose = adjusted(camera, found.pose, sightings, found.inliers);
    AbsolutePose next{pose, inliers_of(now, pose, sightings, options.max_error)};
    const bool same = next.inliers == found.inliers;
    if (next.inliers.size() < found.inliers.size() && round > 0) break;
    found = std::move(next);
    if (same) break;
  }
  return found;
}

PoseDoubt doubt_of(const BundleCamera& camera, std::span<const Sighting> sightings,
                   const AbsolutePose& found) {
  constexpr double kLeastSigma = 0.5;  // [px]
  const PhotographCamera now(camera.now());
  Eigen::MatrixXd normal = Eigen::MatrixXd::Zero(kPoseNumbers, kPoseNumbers);
  double squares = 0;
  std::vector<double> distances;
  for (const std::size_t i : found.inliers) {
    const Eigen::Vector3d X = found.pose.to_camera(sightings[i].point);
    const PhotographImage image = now.image(X);
    if (!image.visible) continue;
    squares += (image.pixel - sightings[i].pixel).squaredNorm();
    distances.push_back(X.norm());
    const refractive::Matrix23<double> by_point = image.by_tangents * image.tangents_by_point;
    Eigen::Matrix<double, 2, kPoseNumbers> by_pose;
    by_pose << -by_point * cross_matrix(X), -by_point * found.pose.rotation;
    normal += by_pose.transpose() * by_pose;
  }
  constexpr double kInfinite = std::numeric_limits<double>::infinity();
  if (distances.size() < 3) return {kInfinite, kInfinite};
  const double distance = upper_median(distances);
  // In units of the distance, the numbers of a pose have one size.
  normal.rightCols<3>() *= distance;
  normal.bottomRows<3>() *= distance;
  const Eigen::LDLT<Eigen::MatrixXd> solver(normal);
  if (!(solver.vectorD().minCoeff() > 1e-12 * solver.vectorD().maxCoeff()))
    return {kInfinite, kInfinite};
  const Eigen::MatrixXd covariance =
      solver.solve(Eigen::MatrixXd::Identity(kPoseNumbers, kPoseNumbers));
  const double sigma =
      std::max(kLeastSigma, std::sqrt(squares / (2 * static_cast<double>(distances.size()))));
  const auto largest = [&](Eigen::Index begin) {
    const EigenPairs pairs = symmetric_eigen(covariance.block(begin, begin, 3, 3));
    return sigma * std::sqrt(std::max(0.0, pairs.values.maxCoeff()));
  };
  return {largest(0), largest(3)};
}

}  // namespace axial::pose
