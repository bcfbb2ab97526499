// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels/photographs_to_map.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <numeric>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <utility>

#include "base/order_statistics.h"
#include "base/parallel.h"
#include "geometry/region_outlines.h"

namespace axial::labels {
namespace {

using Parts = std::vector<std::vector<geometry::Ring>>;

// A polygon in a photograph, or on the map near the origin.
class DrawnPolygon {
 public:
  explicit DrawnPolygon(const Parts& parts) {
    for (const auto& part : parts) {
      lines_.emplace_back();
      for (const geometry::Ring& ring : part) {
        std::vector<cv::Point2f>& line = lines_.back().emplace_back();
        for (const Eigen::Vector2d& corner : ring) {
          line.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
          box_.extend(corner);
        }
      }
    }
  }

  const Eigen::AlignedBox2d& box() const { return box_; }

  bool contains(const Eigen::Vector2d& pixel) const {
    if (!box_.contains(pixel)) return false;
    const cv::Point2f at(static_cast<float>(pixel.x()), static_cast<float>(pixel.y()));
    return std::ranges::any_of(lines_, [&](const auto& part) {
      return std::ranges::count_if(
                 part,
                 [&](const auto& line) { return cv::pointPolygonTest(line, at, false) >= 0; }) %
                 2 ==
             1;
    });
  }

 private:
  std::vector<std::vector<std::vector<cv::Point2f>>> lines_;  // of the rings of each part
  Eigen::AlignedBox2d box_;
};

// Pixels inside the polygon, 250,000 at most, and its corners.
std::vector<Eigen::Vector2d> pixels_in(const DrawnPolygon& polygon, const Parts& parts,
                                       const CameraModel& camera) {
  constexpr double kMost = 250'000;
  const Eigen::Vector2d low = polygon.box().min().cwiseMax(0),
                        high = polygon.box().max().cwiseMin(
                            Eigen::Vector2d(camera.width - 1, camera.height - 1));
  std::vector<Eigen::Vector2d> pixels;
  const double area = std::max(0.0, high.x() - low.x()) * std::max(0.0, high.y() - low.y());
  const double step = std::max(1.0, std::ceil(std::sqrt(area / kMost)));
  for (double y = std::ceil(low.y()); y <= high.y(); y += step)
    for (double x = std::ceil(low.x()); x <= high.x(); x += step)
      if (polygon.contains({x, y})) pixels.emplace_back(x, y);
  for (const auto& part : parts)
    for (const geometry::Ring& ring : part)
      for (const Eigen::Vector2d& corner : ring)
        if (geometry::is_in_image(camera, corner, -0.5)) pixels.push_back(corner);
  return pixels;
}

// The part of the map that pixels see.
struct SeenGround {
  std::vector<Eigen::Vector2d> places;  // of the pixels that see a surface
  Eigen::AlignedBox2d box;
  double width = 0;    // of a pixel on the map: the median
  double missing = 0;  // share of the pixels that see no surface
};

SeenGround ground_of(const LabelledSurface& surface, const PosedRays& rays,
                     const std::vector<Eigen::Vector2d>& pixels) {
  const auto place_at = [&](const Eigen::Vector2d& pixel) {
    const auto sight = rays.sight(pixel);
    return sight ? surface.seen_by(*sight) : std::nullopt;
  };
  std::vector<std::optional<Eigen::Vector3d>> places(pixels.size()), beside(pixels.size());
  parallel_for(
      pixels.size(),
      [&](std::size_t i) {
        places[i] = place_at(pixels[i]);
        beside[i] = place_at(pixels[i] + Eigen::Vector2d::Constant(std::sqrt(0.5)));
      },
      kPointGrain);
  SeenGround ground;
  std::vector<double> widths;
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (!places[i]) continue;
    ground.places.emplace_back(places[i]->head<2>());
    ground.box.extend(ground.places.back());
    if (beside[i]) widths.push_back((*beside[i] - *places[i]).head<2>().norm());
  }
  if (!widths.empty()) ground.width = upper_median(std::move(widths));
  if (!pixels.empty())
    ground.missing =
        1 - static_cast<double>(ground.places.size()) / static_cast<double>(pixels.size());
  return ground;
}

// Samples over the ground, and two more on each side.
geometry::SampleGrid grid_over(const SeenGround& ground) {
  constexpr double kMost = 2048;
  constexpr int kAround = 2;
  const Eigen::Vector2d size = ground.box.sizes();
  const double step = std::max({ground.width, size.maxCoeff() / kMost, 1e-6});
  const auto count = [&](double length) {
    return static_cast<int>(std::ceil(length / step)) + 1 + 2 * kAround;
  };
  return {ground.box.min() - Eigen::Vector2d::Constant(kAround * step), step, count(size.x()),
          count(size.y())};
}

// Weighs parts by the pixels that see them: in an oblique photograph, a bit of ground behind the
// edge of a colony may be larger on the map than the colony.
void leave_out_small(double least_part, const SeenGround& ground, Parts& parts) {
  if (parts.size() < 2) return;
  std::vector<double> weights;
  for (const auto& part : parts) {
    const DrawnPolygon on_map(Parts{part});
    weights.push_back(static_cast<double>(std::ranges::count_if(
        ground.places, [&](const Eigen::Vector2d& place) { return on_map.contains(place); })));
  }
  const double least = least_part * std::accumulate(weights.begin(), weights.end(), 0.0);
  Parts kept;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (weights[i] >= least) kept.push_back(std::move(parts[i]));
  parts = std::move(kept);
}

}  // namespace

CarriedLabel carried_to_map(const LabelledSurface& surface, const PosedRays& rays,
                            const map::Label& drawn, double least_part) {
  const Eigen::Vector3d& origin = surface.origin();
  CarriedLabel carried{{drawn.name, drawn.category, {}, {}}, {}, 0, 1};
  const DrawnPolygon polygon(drawn.parts);
  std::vector<Eigen::Vector2d> pixels = pixels_in(polygon, drawn.parts, rays.posed().camera);
  std::ranges::copy_if(drawn.points, std::back_inserter(pixels),
                       [&](const Eigen::Vector2d& point) { return rays.is_in_photograph(point); });
  const SeenGround ground = ground_of(surface, rays, pixels);
  carried.missing = ground.missing;
  if (!drawn.parts.empty() && !ground.box.isEmpty()) {
    const geometry::SampleGrid grid = grid_over(ground);
    if (ground.width > 0) carried.coarseness = grid.step / ground.width;
    carried.label.parts = geometry::region_outlines(grid, [&](const Eigen::Vector2d& at) {
      const auto place = surface.highest(at);
      const auto pixel = place ? surface.pixel_of(rays, *place) : std::nullopt;
      return pixel && polygon.contains(*pixel);
    });
    leave_out_small(least_part, ground, carried.label.parts);
  }
  for (auto& part : carried.label.parts)
    for (geometry::Ring& ring : part)
      for (Eigen::Vector2d& corner : ring) {
        const auto place = surface.highest(corner);
        carried.heights.push_back(place ? place->z() + origin.z()
                                        : std::numeric_limits<double>::quiet_NaN());
        corner += origin.head<2>();
      }
  for (const Eigen::Vector2d& point : drawn.points) {
    const auto sight = rays.is_in_photograph(point) ? rays.sight(point) : std::nullopt;
    const auto place = sight ? surface.seen_by(*sight) : std::nullopt;
    if (!place) continue;
    carried.label.points.push_back((*place + origin).head<2>());
    carried.heights.push_back(place->z() + origin.z());
  }
  return carried;
}

}  // namespace axial::labels
