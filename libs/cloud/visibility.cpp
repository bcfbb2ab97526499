// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/visibility.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/error.h"
#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

// The projection of a point into one image.
struct ProjectedPoint {
  std::uint32_t point = 0;
  double u = 0, v = 0;  // [px]
  double depth = 0;     // along its ray
  bool asks = false;    // the image is one of the point's views
};

// All points inside the image, sorted by pixel. The points of cell c are points[i] for i in
// [first[c], first[c + 1]).
struct Cells {
  int width = 0, height = 0;
  std::vector<ProjectedPoint> points;
  std::vector<std::size_t> first;

  std::size_t cell(int x, int y) const {
    return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(x);
  }
};

int nearest(double x) {
  return static_cast<int>(std::lround(x));
}

// Sorts the points into cells of one pixel. Within a cell they keep their order.
Cells sorted_into_cells(const std::vector<ProjectedPoint>& points, int width, int height) {
  Cells cells{width, height, {}, {}};
  const auto cell_of = [&](const ProjectedPoint& p) {
    return cells.cell(nearest(p.u), nearest(p.v));
  };
  cells.first.assign(cells.cell(0, height) + 1, 0);
  for (const ProjectedPoint& p : points) ++cells.first[cell_of(p) + 1];
  for (std::size_t c = 1; c < cells.first.size(); ++c) cells.first[c] += cells.first[c - 1];
  cells.points.resize(points.size());
  std::vector<std::size_t> next(cells.first.begin(), cells.first.end() - 1);
  for (const ProjectedPoint& p : points) cells.points[next[cell_of(p)]++] = p;
  return cells;
}

std::vector<std::vector<std::uint32_t>> points_of_images(const Scene& scene) {
  std::vector<std::vector<std::uint32_t>> points(scene.images.size());
  for (std::size_t i = 0; i < scene.points.size(); ++i) {
    std::uint32_t previous = kNoId;
    for (const SparseView& view : scene.points[i].views) {
      if (view.image >= scene.images.size())
        fail("points[{}]: refers to image {}, but there are {} images", i, view.image,
             scene.images.size());
      if (view.image != previous) points[view.image].push_back(static_cast<std::uint32_t>(i));
      previous = view.image;
    }
  }
  return points;
}

Cells project_all(const Scene& scene, const SceneImage& image,
                  const std::vector<std::uint32_t>& own) {
  std::vector<bool> asks(scene.points.size(), false);
  for (const std::uint32_t point : own) asks[point] = true;
  std::vector<ProjectedPoint> points;
  const int width = image.camera.width, height = image.camera.height;
  std::visit(
      [&](const auto& camera) {
        for (std::size_t i = 0; i < scene.points.size(); ++i) {
          const Eigen::Vector3d X = image.pose.to_camera(scene.points[i].position.cast<double>());
          const auto projection = camera.project(X);
          if (!projection.visible) continue;
          const double u = projection.pixel.x(), v = projection.pixel.y();
          if (!(u > -0.5 && v > -0.5 && u < width - 0.5 && v < height - 0.5)) continue;
          const auto ray = camera.ray(projection.pixel);
          const double depth = (X - ray.origin).dot(ray.direction);
          points.push_back({static_cast<std::uint32_t>(i), u, v, depth, asks[i]});
        }
      },
      make_camera<double>(image.camera));
  return sorted_into_cells(points, width, height);
}

// Calls visit(p, q) for every point p that has a view in this image, and every other point q in the
// cone of p.
template <class Visit>
void for_each_in_cone(const Cells& cells, const Visit& visit) {
  constexpr double kHalfPixel = 0.5;
  for (const ProjectedPoint& p : cells.points) {
    if (!p.asks) continue;
    const int x = nearest(p.u), y = nearest(p.v);
    for (int cy = std::max(y - 1, 0); cy <= std::min(y + 1, cells.height - 1); ++cy)
      for (int cx = std::max(x - 1, 0); cx <= std::min(x + 1, cells.width - 1); ++cx)
        for (std::size_t k = cells.first[cells.cell(cx, cy)];
             k < cells.first[cells.cell(cx, cy) + 1]; ++k) {
          const ProjectedPoint& q = cells.points[k];
          if (q.point != p.point && std::hypot(q.u - p.u, q.v - p.v) <= kHalfPixel) visit(p, q);
        }
  }
}

}  // namespace

std::vector<long> visibility_of_points(const Scene& scene) {
  constexpr double kSame = 0.01;
  std::vector<long> visibility(scene.points.size(), 0);
  const auto views = [&](const ProjectedPoint& p) {
    return static_cast<long>(scene.points[p.point].views.size());
  };
  const auto points = points_of_images(scene);
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    if (!scene.images[i].calibrated || points[i].empty()) continue;
    for_each_in_cone(project_all(scene, scene.images[i], points[i]),
                     [&](const ProjectedPoint& p, const ProjectedPoint& q) {
                       if (q.depth > p.depth * (1 + kSame)) visibility[q.point] += views(q);
                       if (q.depth < p.depth * (1 - kSame)) visibility[q.point] -= views(p);
                     });
  }
  return visibility;
}

namespace {

// The width of a pixel at X [camera frame]: 1 / the smaller singular value of the projection's
// derivative, which for a pinhole is z / f. 0 if X is not visible.
template <class Camera>
double pixel_width(const Camera& camera, const Eigen::Vector3d& X) {
  refractive::Matrix23<double> jacobian;
  if (!camera.project(X, &jacobian).visible) return 0;
  const refractive::Matrix2<double> square = jacobian * jacobian.transpose();
  const double half_trace = square.trace() / 2;
  const double spread = std::hypot((square(0, 0) - square(1, 1)) / 2, square(0, 1));
  const double smallest = half_trace - spread;
  return smallest > 0 ? 1 / std::sqrt(smallest) : 0;
}

void add_image(const Scene& scene, std::size_t image, const std::vector<std::uint32_t>& points,
               std::vector<double>& sums, std::vector<int>& counts) {
  const SceneImage& from = scene.images[image];
  std::visit(
      [&](const auto& camera) {
        for (const std::uint32_t point : points) {
          const Eigen::Vector3d X = scene.points[point].position.cast<double>();
          const double width = pixel_width(camera, from.pose.to_camera(X));
          if (!(width > 0)) continue;
          sums[point] += width;
          ++counts[point];
        }
      },
      make_camera<double>(from.camera));
}

}  // namespace

std::vector<PointScale> scales_of_points(const Scene& scene) {
  std::vector<double> sums(scene.points.size(), 0);
  std::vector<int> counts(scene.points.size(), 0);
  const auto points = points_of_images(scene);
  for (std::size_t i = 0; i < scene.images.size(); ++i)
    if (scene.images[i].calibrated) add_image(scene, i, points[i], sums, counts);
  std::vector<PointScale> scales(scene.points.size());
  for (std::size_t i = 0; i < scales.size(); ++i) {
    if (counts[i] == 0) continue;
    scales[i].scale = static_cast<float>(sums[i] / counts[i]);
    for (const SparseView& view : scene.points[i].views) scales[i].confidence += view.confidence;
    if (scales[i].confidence == 0) scales[i].confidence = static_cast<float>(counts[i]);
  }
  return scales;
}

}  // namespace axial::cloud
