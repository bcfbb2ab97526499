// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/point_error.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "scene/any_camera.h"

namespace axial::cloud {
namespace {

// The constants are rounded maximum-likelihood fits, with normally distributed errors, to the
// distances of points from the true surface. The clouds are of SimulateUnderwater scenes (seed 21,
// true poses): closeup and reef in water and in air, thicket in water, each at two resolutions.
// kNoise is from sand in water and reef-hazy in air, because the other scenes have enough texture.
// Several powers of cost and relief were almost equally likely; the chosen ones give the most
// similar results for these scenes and transect. Afterwards kSmoothing and kTriangulated were
// raised by a fifteenth to fit whole clouds, with the results of other seeds known. kOdds was
// rounded by hand.
constexpr double kSmoothing = 3.2;      // error for relief 1 and cost 1, along the normal [pixels]
constexpr double kTriangulated = 0.53;  // the same, relative to the triangulated error of one view
constexpr double kLeastRelief = 1e-3;   // normals 2.6 degrees apart
constexpr double kScatter = 0.9;        // factor of the supports' standard deviation
constexpr double kNoise = 0.26;  // of a photograph, mean over the matching window [grey levels]
constexpr double kLeastTexture = 0.5;   // [grey levels per px]; grey levels are rounded
constexpr double kOdds = 70;            // odds of staying within 3 errors, for a scatter of 1 pixel
constexpr double kLeastScatter = 0.05;  // relative to the error
constexpr double kLeastCosine = 0.1;
constexpr double kNoCost = 0.999;  // a known cost is lower; 1 up to rounding

constexpr int kReach = 3;                 // radius of the surroundings [px]
constexpr std::uint32_t kMostCells = 32;  // along a side of the image

double squared(double x) {
  return x * x;
}
double fourth_root(double x) {
  return std::sqrt(std::sqrt(x));
}

struct Summary {
  double cost = 1;          // smallest cost of the supports
  double pixel = 0;         // width of a pixel at the point [m]
  double cosine = 0;        // mean cosine of the angles between rays and normal
  double variance = 0;      // of the supports' points along the normal [m^2]
  double triangulated = 0;  // triangulated_error()
};

Summary summarise(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  const auto count = static_cast<double>(supports.size());
  Summary sum;
  double offset = 0, square = 0, depth = 0, weights = 0;
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const PointSupport& support : supports) {
    sum.cost = std::min(sum.cost, support.cost);
    sum.cosine += std::abs(normal.dot(support.ray));
    const double along = normal.dot(support.point - supports.front().point);
    offset += along;
    square += along * along;
    depth += support.depth;
    const double weight = 1 / squared(support.pixel);
    weights += weight;
    information -= weight * support.ray * support.ray.transpose();
  }
  information.diagonal().array() += weights + squared(count / depth);
  sum.pixel = std::sqrt(count / weights);
  sum.cosine = std::max(sum.cosine / count, kLeastCosine);
  sum.variance = std::max(square - offset * offset / count, 0.0) / std::max(count - 1, 1.0);
  sum.triangulated = std::sqrt(normal.dot(information.inverse() * normal));
  return sum;
}

// The angular size of a pixel [rad]. M = [dX/du, dX/dv, ray] is the derivative of the point X at
// unit distance by the pixel and by the distance. The first two rows of its inverse are the
// derivative of the pixel by X.
double angle_of_pixel(const AnyCamera<double>& camera, const Eigen::Vector2d& pixel) {
  refractive::AxialRayJacobian<double> by_pixel;
  const Eigen::Vector3d ray = camera.ray(pixel, by_pixel).direction;
  const Eigen::Vector3d by_u = by_pixel.direction.col(0), by_v = by_pixel.direction.col(1);
  const Eigen::Vector3d across = by_v.cross(ray);
  const double scale = 1 / by_u.dot(across);
  return std::sqrt(2 / (across.squaredNorm() + ray.cross(by_u).squaredNorm())) / std::abs(scale);
}

int grey(const FusionMap& map, int x, int y) {  // 4 times the grey level
  const cv::Vec3b bgr = map.color(y, x);
  return bgr[0] + 2 * bgr[1] + bgr[2];
}

// Root mean square of the gradient of the grey level around a pixel [grey levels per px].
double texture_at(const FusionMap& map, int x, int y) {
  int sum = 0, count = 0;
  for (int v = std::max(y - kReach, 1); v <= std::min(y + kReach, map.color.rows - 1); v += kReach)
    for (int u = std::max(x - kReach, 1); u <= std::min(x + kReach, map.color.cols - 1);
         u += kReach) {
      const int here = grey(map, u, v);
      const int by_u = here - grey(map, u - 1, v), by_v = here - grey(map, u, v - 1);
      sum += by_u * by_u + by_v * by_v;
      ++count;
    }
  return std::max(kLeastTexture, std::sqrt(sum / std::max(16.0 * count, 1.0)));
}

bool unknown(const cv::Vec3f& normal) {
  return normal[0] == 0 && normal[1] == 0 && normal[2] == 0;
}

// Surroundings::relief.
double relief_at(const FusionMap& map, int x, int y) {
  constexpr std::array<std::pair<int, int>, 8> kAround{
      {{-1, -1}, {0, -1}, {1, -1}, {-1, 0}, {1, 0}, {-1, 1}, {0, 1}, {1, 1}}};
  const cv::Vec3f& normal = map.normal(y, x);
  double sum = 0;
  int count = 0;
  for (const auto& [dx, dy] : kAround) {
    const int u = x + kReach * dx, v = y + kReach * dy;
    if (u < 0 || v < 0 || u >= map.depth.cols || v >= map.depth.rows) continue;
    const cv::Vec3f& other = map.normal(v, u);
    if (unknown(other)) continue;
    sum += 1 - static_cast<double>(normal.dot(other));
    ++count;
  }
  return unknown(normal) ? 0 : std::max(sum, 0.0) / std::max(count, 1);
}

}  // namespace

SupportCamera::SupportCamera(const CameraModel& model, const Pose& pose)
    : centre_(pose.centre), width_(static_cast<std::uint32_t>(model.width)) {
  const auto height = static_cast<std::uint32_t>(model.height);
  while (std::max(width_, height) > kMostCells << shift_) ++shift_;
  columns_ = ((width_ - 1) >> shift_) + 1;
  const AnyCamera<double> camera(make_camera<double>(model));
  const double half = 0.5 * (1u << shift_);
  for (std::uint32_t y = 0; y < height; y += 1u << shift_)
    for (std::uint32_t x = 0; x < width_; x += 1u << shift_)
      angles_.push_back(static_cast<float>(angle_of_pixel(
          camera, {std::min(x + half, width_ - 1.0), std::min(y + half, height - 1.0)})));
}

PointSupport SupportCamera::support(std::uint32_t pixel, double depth, double cost,
                                    const Eigen::Vector3d& point) const {
  const std::uint32_t y = pixel / width_, x = pixel - y * width_;
  const auto angle = static_cast<double>(angles_[(y >> shift_) * columns_ + (x >> shift_)]);
  return {point, (point - centre_).normalized(), depth * angle, depth, cost};
}

// The noise is divided by `reduction`, because a pixel of a reduced photograph is the mean of
// several pixels.
Surroundings surroundings(const FusionMap& map, std::uint32_t pixel, double reduction) {
  const int width = map.depth.cols, at = static_cast<int>(pixel), y = at / width, x = at % width;
  const double relief = relief_at(map, x, y);
  return {relief, map.color.empty() ? 0 : kNoise / (reduction * texture_at(map, x, y))};
}

double triangulated_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal) {
  return summarise(supports, normal).triangulated;
}

PointError expected_error(std::span<const PointSupport> supports, const Eigen::Vector3d& normal,
                          const Surroundings& around) {
  if (supports.size() < 2) return {};
  const Summary summary = summarise(supports, normal);
  if (!(summary.cost < kNoCost)) return {};
  const double smoothing =
      std::sqrt(summary.cost) * (around.relief + kLeastRelief) / squared(summary.cosine);
  const double of_one_view =
      squared(kTriangulated * summary.triangulated) * static_cast<double>(supports.size());
  const double variance = smoothing * (of_one_view + squared(kSmoothing * summary.pixel)) +
                          squared(kScatter) * summary.variance +
                          squared(around.noise * summary.triangulated);
  const double error = std::sqrt(variance);
  const double scatter = std::sqrt(summary.variance) + kLeastScatter * error;
  const double odds = kOdds / fourth_root(scatter / summary.pixel);
  return {static_cast<float>(error), static_cast<float>(odds / (1 + odds))};
}

}  // namespace axial::cloud
