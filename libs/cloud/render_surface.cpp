// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

#include "base/error.h"
#include "cloud/pinhole_resampling.h"

namespace axial::cloud {
namespace {

struct Vertex {
  Eigen::Vector3d point;  // relative to the pinhole's centre [m]
  double x = 0, y = 0;    // pixel of the pinhole
  double inverse = 0;     // 1 / z [1/m]; 0: no vertex
  float distance = 0;     // depth of the map [m]
};

// Whether the triangle is a surface and not a bridge over a step in depth. It is a bridge if its
// depths differ by more than 1 % and its plane is also nearly parallel to the ray.
bool is_surface(const Vertex& a, const Vertex& b, const Vertex& c) {
  constexpr float kRough = 1.01f;
  constexpr double kSteep = 0.1;  // cosine of the angle between normal and ray
  const auto [least, most] = std::minmax({a.distance, b.distance, c.distance});
  if (most <= kRough * least) return true;
  const Eigen::Vector3d normal = (b.point - a.point).cross(c.point - a.point);
  return std::abs(normal.dot(a.point)) > kSteep * normal.norm() * a.point.norm();
}

// The first and the last pixel centre between three coordinates, within [0, size).
std::pair<int, int> pixels_between(double a, double b, double c, int size) {
  constexpr double kRounding = 1e-7;
  const auto [low, high] = std::minmax({a, b, c});
  return {static_cast<int>(std::clamp(std::ceil(low - kRounding), 0.0, 1.0 * size)),
          static_cast<int>(std::clamp(std::floor(high + kRounding), -1.0, size - 1.0))};
}

// Draws a triangle and keeps the nearest surface at each pixel. A pixel on an edge belongs to both
// triangles, so that there are no gaps. Triangles that are seen from behind are left out.
void draw(const Vertex& a, const Vertex& b, const Vertex& c, cv::Mat1f& inverse) {
  if (a.inverse == 0 || b.inverse == 0 || c.inverse == 0 || !is_surface(a, b, c)) return;
  const double area = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
  if (!(area > 1e-12)) return;
  const auto [left, right] = pixels_between(a.x, b.x, c.x, inverse.cols);
  const auto [top, bottom] = pixels_between(a.y, b.y, c.y, inverse.rows);
  constexpr double kRounding = -1e-7;
  for (int y = top; y <= bottom; ++y)
    for (int x = left; x <= right; ++x) {
      const double of_b = ((x - a.x) * (c.y - a.y) - (y - a.y) * (c.x - a.x)) / area;
      const double of_c = ((b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x)) / area;
      const double of_a = 1 - of_b - of_c;
      if (std::min({of_a, of_b, of_c}) < kRounding) continue;
      const double value = of_a * a.inverse + of_b * b.inverse + of_c * c.inverse;
      inverse(y, x) = std::max(inverse(y, x), static_cast<float>(value));
    }
}

// Draws four neighbouring pixels as two triangles, or as one if only three have a depth.
void draw_quad(const Vertex& a, const Vertex& b, const Vertex& c, const Vertex& d,
               cv::Mat1f& inverse) {
  const bool whole = a.inverse != 0 && b.inverse != 0 && c.inverse != 0 && d.inverse != 0;
  const bool along_ad = whole
                            ? std::abs(a.distance - d.distance) < std::abs(b.distance - c.distance)
                            : b.inverse == 0 || c.inverse == 0;
  if (along_ad) {
    draw(a, b, d, inverse);
    draw(a, d, c, inverse);
  } else {
    draw(a, b, c, inverse);
    draw(b, d, c, inverse);
  }
}

template <class Camera>
void fill_row(const Camera& camera, const DepthMap& map, const PinholeView& view, int v,
              std::vector<Vertex>& row) {
  for (int u = 0; u < map.width(); ++u) {
    Vertex& vertex = row[static_cast<std::size_t>(u)];
    vertex.inverse = 0;
    vertex.distance = map.depth(v, u);
    if (vertex.distance == 0) continue;
    vertex.point = camera.ray({u, v}).at(static_cast<double>(vertex.distance)) - view.centre;
    // The point is behind the pinhole, or too near for a valid depth.
    if (!(vertex.point.z() > 1e-6)) continue;
    const Eigen::Vector2d pixel = view.camera.lens.pixel(vertex.point);
    vertex.x = pixel.x(), vertex.y = pixel.y();
    vertex.inverse = 1 / vertex.point.z();
  }
}

}  // namespace

cv::Mat1f render_surface(const DepthMap& map, const PinholeView& view) {
  if (map.depth.size() != cv::Size(map.camera.width, map.camera.height))
    fail_in(map.image_path, "the depth map is {}x{}, but its camera is {}x{}", map.width(),
            map.height(), map.camera.width, map.camera.height);
  cv::Mat1f inverse(view.camera.height, view.camera.width, 0.0f);
  std::vector<Vertex> above(static_cast<std::size_t>(map.width())), row = above;
  std::visit(
      [&](const auto& camera) {
        for (int v = 0; v < map.height(); ++v) {
          fill_row(camera, map, view, v, row);
          for (std::size_t u = 1; v > 0 && u < row.size(); ++u)
            draw_quad(above[u - 1], above[u], row[u - 1], row[u], inverse);
          std::swap(above, row);
        }
      },
      make_camera<double>(map.camera));
  return inverse;
}

}  // namespace axial::cloud
