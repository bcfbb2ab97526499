// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/pixel_classes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "base/error.h"
#include "base/order_statistics.h"
#include "scene/camera_model.h"

namespace axial::evaluate {
namespace {

// Marks the centres of the windows of 2 reach + 1 pixels that contain both pixels of a jump to the
// next column, or to the next row if `to_row` is 1.
cv::Mat1b windows_with_jumps(const cv::Mat1f& truth, int to_row, const PixelClassOptions& options) {
  cv::Mat1b jumps(truth.size(), std::uint8_t{0});
  for (int v = 0; v + to_row < truth.rows; ++v)
    for (int u = 0; u + 1 - to_row < truth.cols; ++u) {
      const float a = truth(v, u), b = truth(v + to_row, u + 1 - to_row);
      if (std::max(a, b) < static_cast<float>(options.jump) * std::min(a, b)) continue;
      jumps(v, u) = jumps(v + to_row, u + 1 - to_row) = 1;
    }
  // Both pixels of a jump are marked. A window that contains only one of them contains no jump, so
  // the structuring element is two pixels shorter along the jump.
  const int side = 2 * options.reach + 1;
  const cv::Size window = to_row ? cv::Size(side, side - 2) : cv::Size(side - 2, side);
  cv::dilate(jumps, jumps, cv::getStructuringElement(cv::MORPH_RECT, window));
  return jumps;
}

cv::Mat1b edges_of(const cv::Mat1f& truth, const PixelClassOptions& options) {
  cv::Mat1b edges = windows_with_jumps(truth, 0, options);
  cv::bitwise_or(edges, windows_with_jumps(truth, 1, options), edges);
  return edges;
}

cv::Mat1f deviations_of(const cv::Mat1b& grey, int reach) {
  const cv::Size window(2 * reach + 1, 2 * reach + 1);
  cv::Mat1f values, mean, square;
  grey.convertTo(values, CV_32F);
  cv::blur(values, mean, window);
  cv::blur(values.mul(values), square, window);
  cv::Mat1f deviation;
  cv::sqrt(cv::max(square - mean.mul(mean), 0.0), deviation);
  return deviation;
}

// The cosine of the angle between ray and surface normal. The normal is computed from the points of
// the neighbouring pixels, one-sided at the border. 0 beside pixels without truth.
template <class Camera>
double cosine_to_ray(const Camera& camera, const cv::Mat1f& truth, int u, int v) {
  bool whole = true;
  const auto point = [&](int x, int y) -> Eigen::Vector3d {
    whole &= truth(y, x) > 0;
    return camera.ray({x, y}).at(truth(y, x));
  };
  const int right = std::min(u + 1, truth.cols - 1), below = std::min(v + 1, truth.rows - 1);
  const Eigen::Vector3d across = point(right, v) - point(std::max(u - 1, 0), v);
  const Eigen::Vector3d down = point(u, below) - point(u, std::max(v - 1, 0));
  if (!whole) return 0;
  return std::abs(across.cross(down).normalized().dot(camera.ray({u, v}).direction));
}

// The position of a pixel of one map in a source view.
struct SourcePosition {
  double phase;  // fractional part of the true position
  double shift;  // estimated minus true position [px]
};

using Ray = refractive::AxialRay<double>;

// Appends the open pixels of row v to `all`. `rays`: the rays of that row.
template <class Source>
void add_source_positions(const ClassifiedMap& classified, int v, std::span<const Ray> rays,
                          const DepthMap& source_map, const Source& source,
                          std::vector<SourcePosition>& all) {
  const Pose &pose = classified.map->pose, &source_pose = source_map.pose;
  const Eigen::Vector2d last(source_map.camera.width - 1, source_map.camera.height - 1);
  for (int u = 0; u < classified.classes.width; ++u) {
    const double error = classified.evaluation.error(v, u);
    if (classified.classes.at(u, v) != PixelClass::open || std::isnan(error)) continue;
    const Ray& ray = rays[static_cast<std::size_t>(u)];
    refractive::Matrix23<double> jacobian;
    const Eigen::Vector3d point =
        source_pose.to_camera(pose.to_world(ray.at(classified.evaluation.truth(v, u))));
    const auto image = source.project(point, &jacobian);
    const Eigen::Array2d at = image.pixel.array();
    if (!image.visible || !(at >= 0).all() || !(at <= last.array()).all()) continue;
    const Eigen::Vector2d motion =
        jacobian * (source_pose.rotation * pose.rotation.transpose() * ray.direction);
    const int axis = std::abs(motion.x()) > std::abs(motion.y()) ? 0 : 1;
    const double shift = motion(axis) * error;
    if (std::abs(shift) > 0.5) continue;
    all.push_back({image.pixel(axis) - std::floor(image.pixel(axis)), shift});
  }
}

// Works row by row, so that no code is needed for each pair of camera types.
void add_source_positions(const ClassifiedMap& classified, const DepthMap& source,
                          std::vector<SourcePosition>& all) {
  const auto from = make_camera<double>(classified.map->camera),
             to = make_camera<double>(source.camera);
  std::vector<Ray> rays(static_cast<std::size_t>(classified.classes.width));
  for (int v = 0; v < classified.classes.height; ++v) {
    std::visit(
        [&](const auto& camera) {
          for (int u = 0; u < classified.classes.width; ++u)
            rays[static_cast<std::size_t>(u)] = camera.ray({u, v});
        },
        from);
    std::visit(
        [&](const auto& camera) { add_source_positions(classified, v, rays, source, camera, all); },
        to);
  }
}

const DepthMap* first_source(const ClassifiedMap& classified, std::span<const ClassifiedMap> maps) {
  for (std::size_t k = 1; k < classified.map->ids.size(); ++k)
    for (const ClassifiedMap& other : maps)
      if (other.map->ids.front() == classified.map->ids[k]) return other.map;
  return nullptr;
}

}  // namespace

PixelClassMap classes_of(const cv::Mat1f& truth, const CameraModel& camera, const cv::Mat1b& grey,
                         const PixelClassOptions& options) {
  if (truth.size() != cv::Size(camera.width, camera.height) || truth.size() != grey.size())
    fail(
        "the camera is {} x {}, the truth {} x {} and the photograph {} x {}: the sizes must be "
        "the same",
        camera.width, camera.height, truth.cols, truth.rows, grey.cols, grey.rows);
  if (options.reach < 1) fail("reach is {}: must be at least 1 pixel", options.reach);
  const cv::Mat1b edges = edges_of(truth, options);
  const cv::Mat1f deviations = deviations_of(grey, options.reach);
  const double least_cosine = std::cos(options.steep_degrees * std::numbers::pi / 180);
  PixelClassMap classes{truth.cols, truth.rows, {}};
  const auto class_of = [&](const auto& model, int u, int v) {
    if (!(truth(v, u) > 0)) return PixelClass::nothing;
    if (edges(v, u)) return PixelClass::edge;
    if (deviations(v, u) < options.least_deviation) return PixelClass::plain;
    return cosine_to_ray(model, truth, u, v) < least_cosine ? PixelClass::steep : PixelClass::open;
  };
  std::visit(
      [&](const auto& model) {
        for (int v = 0; v < truth.rows; ++v)
          for (int u = 0; u < truth.cols; ++u) classes.pixels.push_back(class_of(model, u, v));
      },
      make_camera<double>(camera));
  return classes;
}

bool is_gross(float error, float truth) {
  return std::abs(error) > static_cast<float>(PixelClassOptions{}.jump - 1) * truth;
}

void Magnitudes::add(float error, float truth) {
  if (!std::isfinite(error)) return;
  all.push_back(std::abs(error));
  if (!is_gross(error, truth)) fine.push_back(all.back());
}

std::array<ClassErrors, 4> errors_by_class(std::span<const ClassifiedMap> maps) {
  constexpr std::array kClasses{PixelClass::edge, PixelClass::plain, PixelClass::steep,
                                PixelClass::open};
  std::array<ClassErrors, 4> result;
  for (std::size_t k = 0; k < kClasses.size(); ++k) {
    result[k].pixel_class = kClasses[k];
    Magnitudes magnitudes;
    for (const ClassifiedMap& classified : maps)
      for (int v = 0; v < classified.classes.height; ++v)
        for (int u = 0; u < classified.classes.width; ++u) {
          if (classified.classes.at(u, v) != kClasses[k]) continue;
          ++result[k].truth_pixels;
          magnitudes.add(classified.evaluation.error(v, u), classified.evaluation.truth(v, u));
        }
    result[k].compared_pixels = magnitudes.all.size();
    result[k].gross_pixels = magnitudes.gross();
    result[k].median = mean_median(magnitudes.all);
    result[k].mean = summarise(magnitudes.fine).mean;
  }
  return result;
}

std::vector<PhaseErrors> errors_by_phase(std::span<const ClassifiedMap> maps, std::size_t bins) {
  std::vector<SourcePosition> positions;
  for (const ClassifiedMap& classified : maps) {
    const DepthMap* source = first_source(classified, maps);
    if (!source) continue;
    add_source_positions(classified, *source, positions);
  }
  const auto count = static_cast<double>(bins);
  std::vector<std::vector<float>> shifts(bins);
  for (const SourcePosition& pixel : positions)
    shifts[std::min(bins - 1, static_cast<std::size_t>(pixel.phase * count))].push_back(
        static_cast<float>(pixel.shift));
  std::vector<PhaseErrors> result(bins);
  for (std::size_t k = 0; k < bins; ++k)
    result[k] = {static_cast<double>(k) / count, static_cast<double>(k + 1) / count,
                 shifts[k].size(), mean_median(shifts[k])};
  return result;
}

}  // namespace axial::evaluate
