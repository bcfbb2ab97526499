// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/agreement.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "base/order_statistics.h"
#include "scene/camera_model.h"

namespace axial::depth {
namespace {

// Cells with fewer points are ignored, because their median is not reliable.
constexpr std::size_t kLeastInCell = 8;
constexpr double kConsistentPixels = 1;
// With a single neighbour, a wrong depth of the neighbour would make a correct pixel inconsistent.
constexpr int kLeastNeighbours = 2;

using Ray = refractive::AxialRay<double>;
using Pixel = Eigen::Vector2d;

// A map with its camera: projections, rays and values at the nearest pixel.
class MapWithCamera {
 public:
  explicit MapWithCamera(const DepthMap& map)
      : map_(map), camera_(make_camera<double>(map.camera)), size_(map.depth.size()) {}

  int width() const { return size_.width; }
  int height() const { return size_.height; }

  // True if `x` [world frame] projects into the image; sets `pixel` to the projection.
  bool shows(const Eigen::Vector3d& x, Pixel& pixel) const {
    bool visible = false;
    const Eigen::Vector3d in_camera = map_.pose.to_camera(x);
    std::visit(
        [&](const auto& camera) {
          const auto seen = camera.project(in_camera);
          visible = seen.visible;
          pixel = seen.pixel;
        },
        camera_);
    return visible && pixel.x() >= 0 && pixel.y() >= 0 && pixel.x() <= size_.width - 1 &&
           pixel.y() <= size_.height - 1;
  }

  double depth_at(const Pixel& pixel) const { return static_cast<double>(at(map_.depth, pixel)); }
  bool has_confidence() const { return !map_.confidence.empty(); }
  float confidence_at(const Pixel& pixel) const { return at(map_.confidence, pixel); }

  // The ray of a pixel in the world frame.
  Ray ray(const Pixel& pixel) const {
    const Ray in_camera =
        std::visit([&](const auto& camera) { return camera.ray(pixel); }, camera_);
    return {map_.pose.to_world(in_camera.origin),
            map_.pose.rotation.transpose() * in_camera.direction};
  }

 private:
  static float at(const cv::Mat1f& values, const Pixel& pixel) {
    return values(static_cast<int>(std::floor(pixel.y() + 0.5)),
                  static_cast<int>(std::floor(pixel.x() + 0.5)));
  }

  const DepthMap& map_;
  CameraVariant<double> camera_;
  cv::Size size_;
};

int cell_of(const MapWithCamera& map, const Pixel& pixel) {
  const auto along = [](double at, int length) {
    return std::min(kCellsAcross - 1, static_cast<int>(kCellsAcross * at / length));
  };
  return along(pixel.y(), map.height()) * kCellsAcross + along(pixel.x(), map.width());
}

// The distance [px] between the images of two points in the first neighbour that shows both; -1 if
// no neighbour does.
double pixels_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                      std::span<const MapWithCamera> neighbours) {
  Pixel seen_a, seen_b;
  for (const MapWithCamera& neighbour : neighbours)
    if (neighbour.shows(a, seen_a) && neighbour.shows(b, seen_b)) return (seen_a - seen_b).norm();
  return -1;
}

// Tests whether the neighbours' depths are consistent with the surface point `x` of a pixel of
// `map`, and counts the result.
void ask(const MapWithCamera& map, const Pixel& pixel, const Eigen::Vector3d& x,
         std::span<const MapWithCamera> neighbours, MapAgreement& result) {
  int asked = 0;
  bool consistent = false;
  for (const MapWithCamera& neighbour : neighbours) {
    Pixel there, back;
    if (!neighbour.shows(x, there)) continue;
    const double depth = neighbour.depth_at(there);
    if (!(depth > 0)) continue;
    ++asked;
    consistent |= map.shows(neighbour.ray(there).at(depth), back) &&
                  (back - pixel).norm() < kConsistentPixels;
  }
  if (asked < kLeastNeighbours) return;
  ++result.asked;
  result.consistent += consistent ? 1 : 0;
}

void compare_point(const MapWithCamera& map, const Eigen::Vector3d& point,
                   std::span<const MapWithCamera> neighbours, MapAgreement& result) {
  Pixel pixel;
  if (!point.allFinite() || !map.shows(point, pixel)) return;
  const double depth = map.depth_at(pixel);
  if (!(depth > 0)) return;
  if (map.has_confidence()) result.scores.push_back(map.confidence_at(pixel));
  const Ray ray = map.ray(pixel);
  const double of_point = (point - ray.origin).dot(ray.direction);
  const Eigen::Vector3d on_map = ray.at(depth);
  ask(map, pixel, on_map, neighbours, result);
  const double pixels = pixels_between(point, on_map, neighbours);
  if (!(pixels >= 0 && of_point > 0)) return;
  result.points.push_back({static_cast<float>(std::abs(depth / of_point - 1)),
                           static_cast<float>(depth < of_point ? -pixels : pixels),
                           cell_of(map, pixel)});
}

struct CellMedian {
  double size;   // |median|
  double error;  // standard error of the median, for a normal distribution
};

CellMedian median_of_cell(std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  const double middle = upper_median(values);
  for (double& value : values) value = std::abs(value - middle);
  return {std::abs(middle), 1.2533 * kSigmasOfMedian * upper_median(values) / std::sqrt(count)};
}

void add_cells(const MapAgreement& map, std::vector<double>& sizes, std::vector<double>& ratios) {
  std::array<std::vector<double>, kCellsAcross * kCellsAcross> cells;
  for (const PointDifference& point : map.points)
    cells[static_cast<std::size_t>(point.cell)].push_back(static_cast<double>(point.pixels));
  for (std::vector<double>& cell : cells) {
    if (cell.size() < kLeastInCell) continue;
    const CellMedian found = median_of_cell(cell);
    sizes.push_back(found.size);
    ratios.push_back(found.size / std::max(found.error, std::numeric_limits<double>::min()));
  }
}

}  // namespace

MapAgreement compare_map(const DepthMap& map, std::span<const DepthMap* const> neighbours,
                         std::span<const Eigen::Vector3f> points, std::size_t most) {
  MapAgreement result;
  if (map.depth.empty()) return result;
  const MapWithCamera asked(map);
  std::vector<MapWithCamera> others;
  for (const DepthMap* const neighbour : neighbours)
    if (neighbour && !neighbour->depth.empty()) others.emplace_back(*neighbour);
  const std::size_t taken = std::min(most, points.size());
  for (std::size_t i = 0; i < taken; ++i)
    compare_point(asked, points[i * points.size() / taken].cast<double>(), others, result);
  return result;
}

Agreement summarise(std::span<const MapAgreement> maps) {
  Agreement result;
  std::vector<double> shares, pixels, sizes, ratios, scores;
  std::size_t consistent = 0;
  for (const MapAgreement& map : maps) {
    for (const PointDifference& point : map.points) {
      shares.push_back(static_cast<double>(point.share));
      pixels.push_back(static_cast<double>(std::abs(point.pixels)));
    }
    add_cells(map, sizes, ratios);
    scores.insert(scores.end(), map.scores.begin(), map.scores.end());
    result.asked += map.asked;
    consistent += map.consistent;
  }
  result.points = pixels.size();
  result.share = upper_median(shares);
  result.pixels = upper_median(pixels);
  result.cells = sizes.size();
  result.scored = scores.size();
  result.score = upper_median(scores);
  result.systematic = upper_median(sizes);
  result.significance = upper_median(ratios);
  if (result.asked > 0)
    result.consistent = static_cast<double>(consistent) / static_cast<double>(result.asked);
  return result;
}

Disagreement judge(const Agreement& agreement, const AgreementLimits& limits) {
  Disagreement result;
  result.pixels = agreement.points >= limits.min_points && agreement.pixels > limits.pixels;
  result.systematic = agreement.cells >= limits.min_cells &&
                      agreement.systematic > limits.systematic &&
                      agreement.significance > limits.significance;
  result.score = agreement.scored >= limits.min_points && agreement.score < limits.score;
  result.consistent =
      agreement.asked >= limits.min_asked && agreement.consistent < limits.consistent;
  return result;
}

}  // namespace axial::depth
