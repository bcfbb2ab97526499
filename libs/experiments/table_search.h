// SPDX-License-Identifier: GPL-3.0-or-later
// The paper's Algorithm 1 with other table layouts than in refractive/line_search.h, to measure the
// influence of the layout on time. The smaller the entry of a pixel in the table, the less a search
// waits for memory.
#pragma once

#include <cmath>
#include <optional>
#include <vector>

#include "refractive/line_search.h"

namespace axial::experiments {

// The entry of a pixel x with 8 numbers, as in the paper: L(x) = {C_v, X_v, c_v}. C_v (3 numbers)
// is the origin of the pixel's ray in water, X_v (3 numbers) the unit direction of the ray, and c_v
// (2 numbers) the principal point of the virtual camera.
template <class T>
struct PlainCell {
  refractive::Vector3<T> centre, direction;  // C_v [m] and X_v, in the camera frame
  refractive::Vector2<T> principal_point;    // c_v [px]

  // Returns the entry of `pixel`.
  static PlainCell of(const FlatPortCamera<T>& camera, const Vector2<T>& pixel) {
    const refractive::AxialRay<T> ray = camera.ray(pixel);
    const refractive::VirtualCamera<T> at = refractive::virtual_camera(camera, pixel);
    return {ray.origin, ray.direction, {at.lens.cx, at.lens.cy}};
  }

  // True if the search for the image of X goes on in the half of the line that is farther from the
  // pinhole image of X. The test is alpha < beta, computed as in the paper. alpha and beta are
  // cosines. X: the point to project [m]. n: the unit normal of the port. Both are in the camera
  // frame.
  bool forward(const refractive::Vector3<T>& X, const refractive::Vector3<T>& n) const {
    const refractive::Vector3<T> from_centre = X - centre;
    return from_centre.dot(n) / from_centre.norm() < direction.dot(n);
  }
};

// The smallest entry for Algorithm 1, with 2 numbers about the pixel's ray in water. `along`: the
// distance [m] of the ray's origin C_v from the camera centre along the port's normal n. `cosine`:
// the cosine of the angle between the ray's direction and n (the paper's beta).
template <class T>
struct TightCell {
  T along, cosine;

  // Returns the entry of `pixel`.
  static TightCell of(const FlatPortCamera<T>& camera, const Vector2<T>& pixel) {
    const refractive::AxialRay<T> ray = camera.ray(pixel);
    return {ray.origin.dot(camera.port().normal), ray.direction.dot(camera.port().normal)};
  }

  // The result is that of PlainCell::forward(), computed from fewer numbers.
  bool forward(const refractive::Vector3<T>& X, const refractive::Vector3<T>& n) const {
    const T height = X.dot(n);
    const T above = height - along;
    const T rho2 = X.squaredNorm() - height * height;
    return above < cosine * std::sqrt(rho2 + above * above);
  }
};

// Projects like refractive::LineSearchCamera, with a table whose entries have the type Cell:
// PlainCell<T> or TightCell<T>. Two results differ: a point exactly on the axis is not visible, and
// the pixel of a point whose search ends outside the image is where the search ends.
template <class T, class Cell>
class TableSearch {
 public:
  using Scalar = T;

  // `width`, `height`: size of the image [px].
  TableSearch(const FlatPortCamera<T>& camera, int width, int height)
      : camera_(camera), width_(width), height_(height) {
    cells_.reserve(static_cast<std::size_t>(width + 2) * static_cast<std::size_t>(height + 2));
    for (int v = -1; v <= height; ++v)
      for (int u = -1; u <= width; ++u)
        cells_.push_back(Cell::of(camera, Vector2<T>(static_cast<T>(u), static_cast<T>(v))));
  }

  // The projection of X [camera frame, m]. X is visible if the search ends inside the image: u in
  // [-1/2, width - 1/2], v in [-1/2, height - 1/2]. X is not visible if it lies on the lens's side
  // of the outer plane, or behind the lens, or is NaN.
  refractive::Projection<T> project(const Vector3<T>& X) const {
    const Vector3<T>& n = camera_.port().normal;
    const refractive::Projection<T> none{Vector2<T>(T(0), T(0)), false};
    if (!(X.dot(n) > camera_.optics().outer()) || !(X.z() > T(0))) return none;
    const Vector2<T> x_p = camera_.lens().pixel(X);
    const Vector2<T> step = refractive::refraction_line(camera_.lens(), n, X);
    const Vector2<T> high(static_cast<T>(width_), static_cast<T>(height_));
    const auto line = refractive::clip_ray<T>(x_p, step, Vector2<T>(T(-1), T(-1)), high);
    if (!line) return none;
    const Vector2<T> x = bisect(*line, X, n);
    const bool inside =
        x.minCoeff() >= T(-0.5) && x.x() <= high.x() - T(0.5) && x.y() <= high.y() - T(0.5);
    return {x, inside};
  }

 private:
  Vector2<T> bisect(refractive::Segment<T> line, const Vector3<T>& X, const Vector3<T>& n) const {
    Vector2<T> t = T(0.5) * (line.end - line.start);
    Vector2<T> x = line.start + t;
    do {
      if (cell(x).forward(X, n)) line.start = x;
      t *= T(0.5);
      x = line.start + t;
    } while (t.squaredNorm() >= T(0.125));  // (sqrt(2)/4)^2
    return x;
  }

  // The entry of the pixel nearest to x, which lies in [-1, width] x [-1, height].
  const Cell& cell(const Vector2<T>& x) const {
    const auto u = static_cast<std::size_t>(x.x() + T(1.5));
    const auto v = static_cast<std::size_t>(x.y() + T(1.5));
    return cells_[v * static_cast<std::size_t>(width_ + 2) + u];
  }

  FlatPortCamera<T> camera_;
  int width_, height_;
  std::vector<Cell> cells_;
};

}  // namespace axial::experiments
