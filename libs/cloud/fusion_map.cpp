// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/fusion_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"
#include "cloud/map_normals.h"
#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

void check(const DepthMap& map, const cv::Mat3b& color) {
  const cv::Size size = map.depth.size();
  const auto agrees = [&](const cv::Mat& image) { return image.empty() || image.size() == size; };
  if (size.empty()) fail_in(map.image_path, "the depth map is empty");
  if (map.camera.width != size.width || map.camera.height != size.height) {
    fail_in(map.image_path, "the depth map is {}x{}, but its camera is {}x{}", size.width,
            size.height, map.camera.width, map.camera.height);
  }
  if (!agrees(map.normal)) fail_in(map.image_path, "normals and depths differ in size");
  if (!agrees(map.confidence)) fail_in(map.image_path, "confidence and depths differ in size");
  if (!agrees(color)) {
    fail_in(map.image_path, "the image is {}x{}, but the depth map is {}x{}", color.cols,
            color.rows, size.width, size.height);
  }
}

float weight_of(float depth, float confidence) {
  return 1.0f / (std::max(1.0f - confidence, 0.03f) * depth * depth);
}

// Normals and weights of one row.
void prepare_row(const DepthMap& map, int y, FusionMap& view) {
  const Eigen::Matrix3d to_world = map.pose.rotation.transpose();
  for (int x = 0; x < map.width(); ++x) {
    const float depth = map.depth(y, x);
    if (!(depth > 0)) continue;
    view.weight(y, x) = weight_of(depth, map.confidence.empty() ? 0.0f : map.confidence(y, x));
    const cv::Vec3f n = map.normal(y, x);
    const Eigen::Vector3d normal = Eigen::Vector3f(n[0], n[1], n[2]).cast<double>();
    const Eigen::Vector3f turned = (to_world * normal).cast<float>();
    view.normal(y, x) = {turned.x(), turned.y(), turned.z()};
  }
}

// An image without gaps between rows, since pixels are addressed by y * width + x.
template <class Image>
Image in_one_run(const Image& image) {
  return image.isContinuous() ? image : Image(image.clone());
}

// Computes the answers of one neighbour. Projections are in single precision: their error of a
// thousandth of a pixel matters only for points that are projected midway between two pixels.
template <class Camera>
class Neighbour {
 public:
  Neighbour(const FusionMap& reference, const FusionMap& neighbour, const Camera& camera,
            const FuseOptions& options)
      : reference_(reference),
        neighbour_(neighbour),
        camera_(camera),
        width_(neighbour.depth.cols),
        height_(neighbour.depth.rows),
        depth_threshold_(static_cast<float>(options.depth_threshold)),
        least_cosine_(static_cast<float>(std::cos(options.normal_threshold))) {}

  // The answer to the pixel `asking` of the reference, whose point [world] is `point`.
  Answer operator()(std::uint32_t asking, const Eigen::Vector3f& point) const {
    const Eigen::Vector3f X = neighbour_.pose.to_camera(point.cast<double>()).cast<float>();
    const auto projection = camera_.project(X);
    if (!projection.visible) return {};
    const float u = std::floor(projection.pixel.x() + 0.5f);
    const float v = std::floor(projection.pixel.y() + 0.5f);
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(width_) && v < static_cast<float>(height_))) {
      return {};
    }
    const auto pixel = static_cast<std::uint32_t>(v) * static_cast<std::uint32_t>(width_) +
                       static_cast<std::uint32_t>(u);
    const float seen = neighbour_.depth_at(pixel);
    if (!(seen > 0)) return {};
    const auto ray = camera_.ray(projection.pixel);
    const float depth = (X - ray.origin).dot(ray.direction);
    if (std::abs(depth - seen) >= depth_threshold_ * depth) {
      return depth < seen ? Answer::contradicts(pixel) : Answer();
    }
    return same_normal(asking, pixel) ? Answer::joins(pixel) : Answer::differs();
  }

 private:
  bool same_normal(std::uint32_t asking, std::uint32_t pixel) const {
    const Eigen::Vector3f mine = reference_.normal_at(asking);
    const Eigen::Vector3f other = neighbour_.normal_at(pixel);
    return mine.isZero(0) || other.isZero(0) || mine.dot(other) > least_cosine_;
  }

  const FusionMap& reference_;
  const FusionMap& neighbour_;
  const Camera& camera_;
  int width_, height_;
  float depth_threshold_, least_cosine_;
};

}  // namespace

FusionMap make_fusion_map(DepthMap map, const cv::Mat3b& color) {
  check(map, color);
  if (map.normal.empty()) map.normal = estimate_map_normals(map);
  FusionMap view{map.image_path,
                 map.pose,
                 map.camera,
                 in_one_run(map.depth),
                 {},
                 {},
                 in_one_run(color),
                 !map.confidence.empty()};
  view.normal = cv::Mat3f(map.depth.size(), cv::Vec3f::all(0));
  view.weight = cv::Mat1f(map.depth.size(), 0.0f);
  parallel_for(static_cast<std::size_t>(map.height()),
               [&](std::size_t y) { prepare_row(map, static_cast<int>(y), view); });
  return view;
}

void back_project(const FusionMap& view, PixelPoints& where) {
  where.points.resize(where.pixels.size());
  const auto width = static_cast<std::uint32_t>(view.depth.cols);
  std::visit(
      [&](const auto& camera) {
        parallel_for(
            where.pixels.size(),
            [&](std::size_t i) {
              const std::uint32_t pixel = where.pixels[i];
              const auto ray = camera.ray({pixel % width, pixel / width});
              const auto depth = static_cast<double>(view.depth_at(pixel));
              where.points[i] = view.pose.to_world(ray.at(depth)).template cast<float>();
            },
            kPointGrain);
      },
      make_camera<double>(view.camera));
}

void ask_neighbour(const FusionMap& reference, const FusionMap& neighbour,
                   const PixelPoints& asking, const FuseOptions& options,
                   std::span<Answer> answers) {
  std::visit(
      [&](const auto& camera) {
        const Neighbour ask(reference, neighbour, camera, options);
        parallel_for(
            answers.size(),
            [&](std::size_t i) { answers[i] = ask(asking.pixels[i], asking.points[i]); },
            kPointGrain);
      },
      make_camera<float>(neighbour.camera));
}

}  // namespace axial::cloud
