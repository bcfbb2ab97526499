// SPDX-License-Identifier: GPL-3.0-or-later
#include "geometry/polygon_pieces.h"

#include <algorithm>
#include <cstdint>
#include <optional>

#include "base/error.h"
#include "base/plane_cross.h"
#include "geometry/convex_part.h"

namespace axial::geometry {
namespace {

using Points = std::vector<Eigen::Vector3d>;

struct Edge {
  Eigen::Vector2d from, to;  // from.x() <= to.x()

  double y_at(double x) const {
    return from.y() + (x - from.x()) / (to.x() - from.x()) * (to.y() - from.y());
  }
};

std::vector<Edge> edges_of(std::span<const Ring> rings) {
  std::vector<Edge> edges;
  for (const Ring& ring : rings)
    for (std::size_t i = 0; i < ring.size(); ++i) {
      Edge edge{ring[i], ring[(i + 1) % ring.size()]};
      if (edge.from == edge.to) continue;
      if (std::pair(edge.from.x(), edge.from.y()) > std::pair(edge.to.x(), edge.to.y()))
        std::swap(edge.from, edge.to);
      edges.push_back(edge);
    }
  std::ranges::sort(edges, {}, [](const Edge& edge) { return edge.from.x(); });
  return edges;
}

// Where the interior of one edge crosses the other edge, or both lie on each other.
std::optional<Eigen::Vector2d> crossing_of(const Edge& one, const Edge& two) {
  const Eigen::Vector2d a = one.to - one.from, b = two.to - two.from, between = two.from - one.from;
  const double turn = plane_cross(a, b);
  if (turn == 0) {
    if (plane_cross(a, between) != 0) return std::nullopt;
    // On one line: the part that both have.
    const double length = a.squaredNorm();
    const double first = a.dot(between) / length, second = a.dot(two.to - one.from) / length;
    const double low = std::max(0.0, std::min(first, second));
    const double high = std::min(1.0, std::max(first, second));
    if (!(high > low)) return std::nullopt;
    return Eigen::Vector2d(one.from + (low + high) / 2 * a);
  }
  const double on_one = plane_cross(between, b) / turn, on_two = plane_cross(between, a) / turn;
  const auto is_inside = [](double share, const Eigen::Vector2d& edge) {
    return std::min(share, 1 - share) * edge.norm() > kTouch;
  };
  if (!is_inside(on_one, a) || !is_inside(on_two, b)) return std::nullopt;
  return Eigen::Vector2d(one.from + on_one * a);
}

// Keeps the part on which `distance` is 0 or more. `spare`: memory.
template <class Distance>
void keep(Points& part, Points& spare, const Distance& distance) {
  convex_part(part, distance, spare);
  part.swap(spare);
}

}  // namespace

double signed_area(const Ring& ring) {
  double twice = 0;  // relative to a corner, so that large coordinates cost no digits
  for (std::size_t i = 2; i < ring.size(); ++i)
    twice += plane_cross(ring[i - 1] - ring[0], ring[i] - ring[0]);
  return twice / 2;
}

std::optional<Eigen::Vector2d> crossing_of(std::span<const Ring> rings) {
  constexpr std::uint64_t kMostPairs = 1'000'000'000;
  const std::vector<Edge> edges = edges_of(rings);
  std::uint64_t pairs = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size() && edges[j].from.x() <= edges[i].to.x(); ++j) {
      if (++pairs > kMostPairs) fail("has too many edges above each other: simplify it");
      if (const auto place = crossing_of(edges[i], edges[j])) return place;
    }
  return std::nullopt;
}

double PolygonPieces::Trapezoid::low_at(double x) const {
  return low[0] + (x - left) / (right - left) * (low[1] - low[0]);
}

double PolygonPieces::Trapezoid::high_at(double x) const {
  return high[0] + (x - left) / (right - left) * (high[1] - high[0]);
}

PolygonPieces::PolygonPieces(std::span<const Ring> rings) {
  constexpr std::size_t kMostPieces = 10'000'000;
  for (const Ring& ring : rings)
    for (const Eigen::Vector2d& corner : ring) lines_.push_back(corner.x());
  std::ranges::sort(lines_);
  lines_.erase(std::unique(lines_.begin(), lines_.end()), lines_.end());
  const std::vector<Edge> edges = edges_of(rings);
  std::vector<Edge> across;  // of the strip
  std::size_t next = 0;
  for (std::size_t strip = 0; strip + 1 < lines_.size(); ++strip) {
    const double left = lines_[strip], right = lines_[strip + 1], middle = (left + right) / 2;
    std::erase_if(across, [&](const Edge& edge) { return edge.to.x() <= left; });
    for (; next < edges.size() && edges[next].from.x() <= left; ++next)
      if (edges[next].to.x() > left) across.push_back(edges[next]);
    std::ranges::sort(across, {}, [&](const Edge& edge) { return edge.y_at(middle); });
    begin_.push_back(pieces_.size());
    for (std::size_t i = 0; i + 1 < across.size(); i += 2) {
      const Edge &low = across[i], &high = across[i + 1];
      pieces_.push_back(
          {left, right, {low.y_at(left), low.y_at(right)}, {high.y_at(left), high.y_at(right)}});
      area_ += (right - left) * (pieces_.back().high - pieces_.back().low).sum() / 2;
    }
    if (pieces_.size() > kMostPieces) fail("has too many edges above each other: simplify it");
  }
  begin_.push_back(pieces_.size());
}

std::size_t PolygonPieces::strip_at(double x) const {
  const auto line = std::ranges::upper_bound(lines_, x);
  const auto strip = std::max<std::ptrdiff_t>(0, line - lines_.begin() - 1);
  return std::min(static_cast<std::size_t>(strip), begin_.size() - 2);
}

bool PolygonPieces::contains(const Eigen::Vector2d& place) const {
  const double x = place.x();
  if (begin_.size() < 2 || x < lines_.front() || x > lines_.back()) return false;
  return std::ranges::any_of(strip(strip_at(x)), [&](const Trapezoid& piece) {
    return place.y() >= piece.low_at(x) && place.y() <= piece.high_at(x);
  });
}

void PolygonPieces::clip(const std::array<Eigen::Vector3d, 3>& corners, Scratch& scratch,
                         const std::function<void(std::span<const Eigen::Vector3d>)>& use) const {
  const auto [left, right] = std::minmax({corners[0].x(), corners[1].x(), corners[2].x()});
  const auto [low, high] = std::minmax({corners[0].y(), corners[1].y(), corners[2].y()});
  if (begin_.size() < 2 || right < lines_.front() || left > lines_.back()) return;
  auto& [part, spare] = scratch;
  for (std::size_t index = strip_at(left); index + 1 < begin_.size() && lines_[index] <= right;
       ++index)
    for (const Trapezoid& piece : strip(index)) {
      if (piece.low.minCoeff() > high || piece.high.maxCoeff() < low) continue;
      part.assign(corners.begin(), corners.end());
      keep(part, spare, [&](const Eigen::Vector3d& x) { return x.x() - piece.left; });
      keep(part, spare, [&](const Eigen::Vector3d& x) { return piece.right - x.x(); });
      keep(part, spare, [&](const Eigen::Vector3d& x) { return x.y() - piece.low_at(x.x()); });
      keep(part, spare, [&](const Eigen::Vector3d& x) { return piece.high_at(x.x()) - x.y(); });
      if (part.size() >= 3) use(part);
    }
}

}  // namespace axial::geometry
