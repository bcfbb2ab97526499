// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/sparse_init.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <variant>

namespace axial::depth {
namespace {

struct Corner {
  cv::Point2f pixel;
  Eigen::Vector3f point;
};

template <class Camera>
std::vector<Corner> visible_corners(const Camera& camera, const CameraModel& model,
                                    std::span<const Eigen::Vector3f> points) {
  std::vector<Corner> corners;
  for (const Eigen::Vector3f& point : points) {
    const auto image = camera.project(point);
    const auto [u, v] = std::pair(image.pixel.x(), image.pixel.y());
    if (image.visible && u >= 0 && v >= 0 && u <= static_cast<float>(model.width - 1) &&
        v <= static_cast<float>(model.height - 1))
      corners.push_back({{u, v}, point});
  }
  return corners;
}

// Twice the signed area of the triangle (a, b, p).
float edge(const cv::Point2f& a, const cv::Point2f& b, const cv::Point2f& p) {
  return (b.x - a.x) * (p.y - a.y) - (b.y - a.y) * (p.x - a.x);
}

template <class Camera>
void rasterise(const Camera& camera, const std::array<const Corner*, 3>& triangle, float min_depth,
               float max_depth, PlaneMap& map) {
  const auto& [a, b, c] = triangle;
  const float area = edge(a->pixel, b->pixel, c->pixel);
  Eigen::Vector3f normal = (b->point - a->point).cross(c->point - a->point);
  if (!(std::abs(area) > 1e-3f) || !(normal.squaredNorm() > 0)) return;
  normal.normalize();
  const float sign = area > 0 ? 1.0f : -1.0f;
  const auto [x_min, x_max] = std::minmax({a->pixel.x, b->pixel.x, c->pixel.x});
  const auto [y_min, y_max] = std::minmax({a->pixel.y, b->pixel.y, c->pixel.y});
  const int x_end = std::min(map.width - 1, static_cast<int>(std::floor(x_max)));
  const int y_end = std::min(map.height - 1, static_cast<int>(std::floor(y_max)));
  for (int y = static_cast<int>(std::ceil(y_min)); y <= y_end; ++y) {
    for (int x = static_cast<int>(std::ceil(x_min)); x <= x_end; ++x) {
      const cv::Point2f p(static_cast<float>(x), static_cast<float>(y));
      if (sign * edge(a->pixel, b->pixel, p) < 0 || sign * edge(b->pixel, c->pixel, p) < 0 ||
          sign * edge(c->pixel, a->pixel, p) < 0)
        continue;
      const auto ray = camera.ray({p.x, p.y});
      const float along = normal.dot(ray.direction);
      if (std::abs(along) < 0.05f) continue;
      const float depth = normal.dot(a->point - ray.origin) / along;
      if (!(depth >= min_depth && depth <= max_depth)) continue;
      map.at(x, y).plane = {depth, along < 0 ? normal : Eigen::Vector3f(-normal)};
      map.at(x, y).point = ray.at(depth);
    }
  }
}

// OpenCV's triangulation returns the single-precision vertices exactly as they were inserted, so a
// vertex identifies its corner.
using CornerByPixel = std::map<std::pair<float, float>, const Corner*>;

std::vector<std::array<const Corner*, 3>> triangulate(const CameraModel& model,
                                                      const std::vector<Corner>& corners) {
  cv::Subdiv2D subdivision(cv::Rect(-1, -1, model.width + 2, model.height + 2));
  CornerByPixel by_pixel;
  for (const Corner& corner : corners) {
    if (!by_pixel.emplace(std::pair(corner.pixel.x, corner.pixel.y), &corner).second) continue;
    subdivision.insert(corner.pixel);
  }
  std::vector<cv::Vec6f> triangles;
  subdivision.getTriangleList(triangles);
  std::vector<std::array<const Corner*, 3>> result;
  for (const cv::Vec6f& t : triangles) {
    std::array<const Corner*, 3> triangle{};
    bool known = true;
    for (int k = 0; k < 3; ++k) {
      const auto found = by_pixel.find({t[2 * k], t[2 * k + 1]});
      known = known && found != by_pixel.end();
      if (known) triangle[static_cast<std::size_t>(k)] = found->second;
    }
    if (known) result.push_back(triangle);
  }
  return result;
}

}  // namespace

PlaneMap planes_from_points(const CameraModel& camera, std::span<const Eigen::Vector3f> points,
                            float min_depth, float max_depth) {
  PlaneMap map(camera.width, camera.height);
  std::visit(
      [&](const auto& exact) {
        const std::vector<Corner> corners = visible_corners(exact, camera, points);
        if (corners.size() < 3) return;
        for (const auto& triangle : triangulate(camera, corners))
          rasterise(exact, triangle, min_depth, max_depth, map);
      },
      make_camera<float>(camera));
  return map;
}

}  // namespace axial::depth
