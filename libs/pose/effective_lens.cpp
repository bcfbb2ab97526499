// SPDX-License-Identifier: GPL-3.0-or-later
#include "pose/effective_lens.h"

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <string_view>
#include <vector>

#include "base/error.h"

namespace axial::pose {
namespace {

constexpr std::size_t kLens = 8;  // fx, fy, cx, cy and four of the distortion
// And the turn of the fitted camera about x and y [rad] and the shift of its centre [m].
constexpr std::size_t kNumbers = kLens + 5;
constexpr int kColumns = 40, kRows = 30;
constexpr double kNear = 0.7, kFar = 1.4;  // times the distance

using LensNumbers = Eigen::Matrix<double, kNumbers, 1>;

// A point in the water and its image.
struct Sample {
  Eigen::Vector3d point;  // camera frame [m]
  Eigen::Vector2d pixel;
};

std::vector<Sample> samples_of(const HousedCamera& camera, double distance) {
  const PhotographCamera photograph(camera);
  std::vector<Sample> samples;
  for (int k = 0; k < kColumns * kRows; ++k) {
    const Eigen::Vector2d pixel((k % kColumns + 0.5) * camera.lens.width / kColumns - 0.5,
                                (k / kColumns + 0.5) * camera.lens.height / kRows - 0.5);
    const auto ray = photograph.ray(pixel);
    if (!ray.origin.allFinite() || !(ray.direction.z() > 0)) continue;
    for (const double depth : {kNear * distance, kFar * distance})
      samples.push_back(
          {ray.origin + (depth - ray.origin.z()) / ray.direction.z() * ray.direction, pixel});
  }
  return samples;
}

lens::Lens lens_with(const lens::Lens& shape, const LensNumbers& x) {
  lens::Lens lens = shape;
  lens.pinhole = {x(0), x(1), x(2), x(3)};
  lens.distortion.assign(x.data() + 4, x.data() + kLens);
  return lens;
}

// The image of a point by the fitted camera.
Eigen::Vector2d image_of(const lens::Lens& lens, const LensNumbers& x,
                         const Eigen::Vector3d& point) {
  const Eigen::Vector3d turn(x(kLens), x(kLens + 1), 0);
  const Eigen::Vector3d moved = point - x.tail<3>();
  const Eigen::Vector3d seen =
      Eigen::AngleAxisd(turn.norm(), turn.stableNormalized()).toRotationMatrix() * moved;
  return image_direction(lens, seen.x() / seen.z(), seen.y() / seen.z());
}

// Many lenses with a turned camera image nearly alike. Of these, the one that turns and moves least
// is taken: a turn of 1 degree, a shift of 1 cm and a tangential distortion of 0.01 count as 0.02
// px.
LensNumbers weights_of(std::size_t samples) {
  LensNumbers weights = LensNumbers::Zero();
  weights.segment<2>(6).setConstant(2);
  weights.segment<2>(kLens).setConstant(1);
  weights.tail<3>().setConstant(2);
  return static_cast<double>(samples) * weights.cwiseAbs2();
}

// The sum of squared errors and of weighted numbers [px^2]. Points that have no image make it
// infinite.
double cost_of(const lens::Lens& shape, const LensNumbers& x, std::span<const Sample> samples) {
  const lens::Lens lens = lens_with(shape, x);
  double sum = 0;
  for (const Sample& sample : samples)
    sum += (image_of(lens, x, sample.point) - sample.pixel).squaredNorm();
  sum += weights_of(samples.size()).dot(x.cwiseAbs2());
  return std::isfinite(sum) ? sum : std::numeric_limits<double>::infinity();
}

// The normal equations of the errors, with numerical derivatives.
void linearise(const lens::Lens& shape, const LensNumbers& x, const LensNumbers& steps,
               std::span<const Sample> samples, Eigen::Matrix<double, kNumbers, kNumbers>& normal,
               LensNumbers& gradient) {
  normal.setZero();
  gradient.setZero();
  const auto image = [&](const LensNumbers& at, const Sample& sample) {
    return image_of(lens_with(shape, at), at, sample.point);
  };
  for (const Sample& sample : samples) {
    Eigen::Matrix<double, 2, kNumbers> by;
    for (Eigen::Index k = 0; k < by.cols(); ++k) {
      LensNumbers low = x, high = x;
      low(k) -= steps(k);
      high(k) += steps(k);
      by.col(k) = (image(high, sample) - image(low, sample)) / (2 * steps(k));
    }
    normal += by.transpose() * by;
    gradient += by.transpose() * (image(x, sample) - sample.pixel);
  }
  const LensNumbers weights = weights_of(samples.size());
  normal.diagonal() += weights;
  gradient += weights.cwiseProduct(x);
}

// Levenberg's method from a lens without distortion.
EffectiveLens fitted(std::string_view model, const HousedCamera& camera, double distance,
                     std::span<const Sample> samples) {
  constexpr int kIterations = 100;
  lens::Lens shape{lens::find_model(model), {}, {}, camera.lens.width, camera.lens.height};
  const auto& pinhole = camera.lens.pinhole;
  constexpr double kWater = 1.333;
  const double factor = camera.port ? kWater : 1;
  LensNumbers x = LensNumbers::Zero(), steps;
  x.head<4>() << factor * pinhole.fx, factor * pinhole.fy, pinhole.cx, pinhole.cy;
  const double shift = 1e-6 * distance;
  steps << 1e-3, 1e-3, 1e-3, 1e-3, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, shift, shift, shift;
  double cost = cost_of(shape, x, samples), damping = 1e-3;
  for (int i = 0; i < kIterations && damping < 1e12; ++i) {
    Eigen::Matrix<double, kNumbers, kNumbers> normal;
    LensNumbers gradient;
    linearise(shape, x, steps, samples, normal, gradient);
    normal.diagonal() *= 1 + damping;
    const LensNumbers next = x - LensNumbers(normal.ldlt().solve(gradient));
    const double trial = cost_of(shape, next, samples);
    const bool is_better = trial < cost;
    const bool is_done = is_better && cost - trial < 1e-10 * cost;
    damping *= is_better ? 0.1 : 10;
    if (is_better) x = next, cost = trial;
    if (is_done) break;
  }
  EffectiveLens result{lens_with(shape, x)};
  double sum = 0;
  for (const Sample& sample : samples) {
    const double error = (image_of(result.lens, x, sample.point) - sample.pixel).norm();
    sum += error * error;
    result.largest = std::max(result.largest, error);
  }
  result.rms = std::sqrt(sum / static_cast<double>(samples.size()));
  return result;
}

}  // namespace

EffectiveLens effective_lens(const HousedCamera& camera, double distance) {
  if (!(distance > 0 && std::isfinite(distance)))
    fail("the distance of the scene is {} m, expected a positive number", distance);
  const std::vector<Sample> samples = samples_of(camera, distance);
  if (samples.size() < static_cast<std::size_t>(kColumns * kRows))  // two for each pixel
    fail("fewer than half of the pixels see through the port");
  EffectiveLens best = fitted("OPENCV", camera, distance, samples);
  EffectiveLens fisheye = fitted("OPENCV_FISHEYE", camera, distance, samples);
  if (!(fisheye.rms < 0.99 * best.rms)) return best;
  return fisheye;
}

}  // namespace axial::pose
