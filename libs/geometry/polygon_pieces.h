// SPDX-License-Identifier: GPL-3.0-or-later
// Polygons with holes and several parts, and the parts of triangles above or below them.
#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace axial::geometry {

// A closed line in the plane z = 0: its corners in either direction, without a repetition of the
// first corner.
using Ring = std::vector<Eigen::Vector2d>;

// The area of a ring without crossings: above 0 if its corners follow each other against the
// direction of clock hands, with x to the right and y upwards.
double signed_area(const Ring& ring);

// A place at which rings cross themselves or each other, or run along each other; nullopt if there
// is none. Rings may touch or cross in corners. Crossings up to kTouch from a corner count as
// touching. Precondition: the coordinates are finite. Error if more than 1e9 pairs of edges overlap
// in x.
inline constexpr double kTouch = 1e-4;  // [m]: rounded coordinates of a point where two rings touch
std::optional<Eigen::Vector2d> crossing_of(std::span<const Ring> rings);

// A polygon: the points that lie inside an odd number of rings. So a ring in another ring is a
// hole, and rings beside each other are parts of one polygon.
class PolygonPieces {
 public:
  // Precondition: crossing_of() is nullopt, and the coordinates are finite. Large common offsets of
  // the coordinates cost digits. Error if the polygon has more than 10 million pieces.
  explicit PolygonPieces(std::span<const Ring> rings);

  double area() const { return area_; }
  bool contains(const Eigen::Vector2d& place) const;

  // Memory of clip().
  struct Scratch {
    std::vector<Eigen::Vector3d> part, spare;
  };

  // Calls `use` for each piece of the triangle above or below the polygon: 3 to 7 corners of a
  // convex polygon in the plane of the triangle, in the triangle's direction. Their union is the
  // whole part, and they overlap in lines only. The numbers of a piece may be those of a triangle
  // without area.
  void clip(const std::array<Eigen::Vector3d, 3>& corners, Scratch& scratch,
            const std::function<void(std::span<const Eigen::Vector3d>)>& use) const;

 private:
  // Between two vertical lines: y from `low` to `high` at both of them.
  struct Trapezoid {
    double left = 0, right = 0;
    Eigen::Vector2d low, high;

    double low_at(double x) const;
    double high_at(double x) const;
  };
  // The strip that contains x, or the nearest one. Precondition: there is a strip.
  std::size_t strip_at(double x) const;
  std::span<const Trapezoid> strip(std::size_t index) const {
    return std::span(pieces_).subspan(begin_[index], begin_[index + 1] - begin_[index]);
  }

  std::vector<double> lines_;       // x of the vertical lines, in increasing order
  std::vector<Trapezoid> pieces_;   // strip by strip, in each strip from below
  std::vector<std::size_t> begin_;  // of the strips in pieces_; the last is the end
  double area_ = 0;
};

}  // namespace axial::geometry
