// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/pinhole_view.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "refractive/nearest_point.h"

namespace axial::cloud {
namespace {

using Ray = refractive::AxialRay<double>;

constexpr double kSteepest = 0.342;  // cos of 70 degrees
constexpr double kLargest = 1.4;     // largest side of the image relative to the model's image

struct Rays {
  std::vector<Ray> all;           // on a grid over the whole image, up to its edges
  bool whole = true;              // every pixel of the grid has a ray
  Ray right, left, below, above;  // half a pixel from the image's centre
};

// Whether a point on the pixel's ray is projected back to the pixel. This fails beyond total
// reflection, outside the lens's field, and more than 70 degrees from the axis.
template <class Camera>
bool is_seen(const Camera& camera, const Eigen::Vector2d& pixel, const Ray& ray, double distance) {
  const auto seen = camera.project(ray.at(distance));
  return seen.visible && (seen.pixel - pixel).norm() < 0.1 && ray.direction.z() > kSteepest;
}

template <class Camera>
Rays rays_of(const Camera& camera, const CameraModel& model, double distance) {
  constexpr int kSteps = 32;
  Rays rays;
  for (int i = 0; i <= kSteps; ++i)
    for (int k = 0; k <= kSteps; ++k) {
      const Eigen::Vector2d pixel(-0.5 + model.width * static_cast<double>(k) / kSteps,
                                  -0.5 + model.height * static_cast<double>(i) / kSteps);
      const Ray ray = camera.ray(pixel);
      if (is_seen(camera, pixel, ray, distance))
        rays.all.push_back(ray);
      else
        rays.whole = false;
    }
  const Eigen::Vector2d centre((model.width - 1) / 2.0, (model.height - 1) / 2.0);
  rays.right = camera.ray(centre + Eigen::Vector2d(0.5, 0));
  rays.left = camera.ray(centre - Eigen::Vector2d(0.5, 0));
  rays.below = camera.ray(centre + Eigen::Vector2d(0, 0.5));
  rays.above = camera.ray(centre - Eigen::Vector2d(0, 0.5));
  return rays;
}

Eigen::Vector3d nearest_point(const std::vector<Ray>& rays) {
  const auto equations = refractive::nearest_point_equations(std::span<const Ray>(rays));
  return equations.normal.inverse() * equations.right;
}

Eigen::Vector2d tangents(const Ray& ray, double distance, const Eigen::Vector3d& centre) {
  const Eigen::Vector3d seen = ray.at(distance) - centre;
  return seen.head<2>() / seen.z();
}

// The lens whose pixels have the angular size of the model's pixels in the image's centre. The
// principal point is left at 0.
refractive::PinholeLens<double> focal_lengths(const CameraModel& model, const Rays& rays,
                                              double distance, const Eigen::Vector3d& centre) {
  const auto at = [&](const Ray& ray) { return tangents(ray, distance, centre); };
  Eigen::Matrix2d by_pixel;
  by_pixel << at(rays.right) - at(rays.left), at(rays.below) - at(rays.above);
  const double ratio = model.lens.fx / model.lens.fy;
  const double fy = 1 / std::sqrt(std::abs(by_pixel.determinant()) * ratio);
  return {ratio * fy, fy, 0, 0};
}

// The size and principal point of the image along one axis [px].
struct Side {
  int pixels = 0;
  double principal_point = 0;
  bool whole = true;  // the image contains all tangents
};

// For tangents from `low` to `high`. `middle`: the tangent that the centre of the model's image
// sees. `of_model`: the side of the model's image [px].
Side side_for(double low, double high, double middle, double focal, int of_model) {
  const double reach = kLargest / 2 * of_model / focal;
  const double first = std::max(low, middle - reach), last = std::min(high, middle + reach);
  const double length = focal * (last - first);
  const int pixels = std::max(1, static_cast<int>(std::ceil(length - 1e-6)));
  // The fraction of a pixel that rounding adds is divided between both ends.
  const double principal_point = -0.5 + (pixels - length) / 2 - focal * first;
  return {pixels, principal_point, first == low && last == high};
}

}  // namespace

PinholeView PinholeView::resized(int width, int height) const {
  return {camera.resized(width, height), centre, whole};
}

PinholeView pinhole_for(const CameraModel& model, double near, double far) {
  if (!model.port && !model.distortion) return {model, Eigen::Vector3d::Zero(), true};
  const double middle = 2 / (1 / near + 1 / far);
  const Rays rays = std::visit([&](const auto& camera) { return rays_of(camera, model, middle); },
                               make_camera<double>(model));
  PinholeView view;
  view.centre = nearest_point(rays.all);
  view.camera.lens = focal_lengths(model, rays, middle, view.centre);
  Eigen::Array2d low = Eigen::Array2d::Constant(1e9), high = -low;
  for (const Ray& ray : rays.all)
    for (const double distance : {near, far}) {
      const Eigen::Array2d at = tangents(ray, distance, view.centre);
      low = low.min(at), high = high.max(at);
    }
  const Eigen::Vector2d centre =
      (tangents(rays.left, middle, view.centre) + tangents(rays.right, middle, view.centre)) / 2;
  refractive::PinholeLens<double>& lens = view.camera.lens;
  const Side across = side_for(low.x(), high.x(), centre.x(), lens.fx, model.width);
  const Side down = side_for(low.y(), high.y(), centre.y(), lens.fy, model.height);
  view.camera.width = across.pixels, view.camera.height = down.pixels;
  lens.cx = across.principal_point, lens.cy = down.principal_point;
  view.whole = rays.whole && across.whole && down.whole;
  return view;
}

}  // namespace axial::cloud
