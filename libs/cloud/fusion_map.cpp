// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/fusion_map.h"

#include <algorithm>
#include <cmath>

#include "base/error.h"
#include "base/parallel.h"

namespace axial::cloud {
namespace {

void check(const DepthMap& map, const cv::Mat3b& color) {
  const cv::Size size = map.depth.size();
  const auto agrees = [&](const cv::Mat& image) { return image.empty() || image.size() == size; };
  if (size.empty()) fail("{}: the depth map is empty", map.image_path);
  if (map.camera.width != size.width || map.camera.height != size.height) {
    fail("{}: the depth map is {}x{}, but its camera {}x{}", map.image_path, size.width,
         size.height, map.camera.width, map.camera.height);
  }
  if (!agrees(map.normal)) fail("{}: normals and depths differ in size", map.image_path);
  if (!agrees(map.confidence)) fail("{}: confidence and depths differ in size", map.image_path);
  if (!agrees(color)) {
    fail("{}: the image is {}x{}, but the depth map {}x{}", map.image_path, color.cols, color.rows,
         size.width, size.height);
  }
}

float weight_of(float depth, float confidence) {
  return 1.0f / (std::max(1.0f - confidence, 0.03f) * depth * depth);
}

template <class Camera>
void back_project_row(const Camera& camera, int y, FusionMap& view) {
  const DepthMap& map = view.map;
  const Eigen::Matrix3d to_world = map.pose.rotation.transpose();
  std::size_t i = static_cast<std::size_t>(y) * static_cast<std::size_t>(map.width());
  for (int x = 0; x < map.width(); ++x, ++i) {
    const float depth = map.depth(y, x);
    if (!(depth > 0)) continue;
    const auto ray = camera.ray({x, y});
    const Eigen::Vector3d in_camera = ray.at(static_cast<double>(depth));
    view.point[i] = map.pose.to_world(in_camera).template cast<float>();
    view.weight[i] = weight_of(depth, map.confidence.empty() ? 0.0f : map.confidence(y, x));
    if (map.normal.empty()) continue;
    const cv::Vec3f n = map.normal(y, x);
    const Eigen::Vector3d normal = Eigen::Vector3f(n[0], n[1], n[2]).cast<double>();
    view.normal[i] = (to_world * normal).cast<float>();
  }
}

// Answers of one neighbour. Float projection: its error of a thousandth of a pixel only matters to
// points that fall between two pixels anyway.
template <class Camera>
class Neighbour {
 public:
  Neighbour(const FusionMap& reference, const FusionMap& neighbour, const Camera& camera,
            const FuseOptions& options)
      : reference_(reference),
        neighbour_(neighbour),
        camera_(camera),
        width_(neighbour.map.width()),
        height_(neighbour.map.height()),
        depth_threshold_(static_cast<float>(options.depth_threshold)),
        least_cosine_(static_cast<float>(std::cos(options.normal_threshold))) {}

  Answer operator()(std::uint32_t asking) const {
    const Eigen::Vector3f X = in_camera(neighbour_, reference_.point[asking]);
    const auto projection = camera_.project(X);
    if (!projection.visible) return {};
    const float u = std::floor(projection.pixel.x() + 0.5f);
    const float v = std::floor(projection.pixel.y() + 0.5f);
    if (!(u >= 0 && v >= 0 && u < static_cast<float>(width_) && v < static_cast<float>(height_))) {
      return {};
    }
    const auto pixel = static_cast<std::uint32_t>(v) * static_cast<std::uint32_t>(width_) +
                       static_cast<std::uint32_t>(u);
    const float seen = neighbour_.depth(pixel);
    if (!(seen > 0)) return {};
    const auto ray = camera_.ray(projection.pixel);
    const float depth = (X - ray.origin).dot(ray.direction);
    if (std::abs(depth - seen) >= depth_threshold_ * depth) {
      return depth < seen ? Answer::contradicts(pixel) : Answer();
    }
    return same_normal(asking, pixel) ? Answer::joins(pixel) : Answer();
  }

 private:
  static Eigen::Vector3f in_camera(const FusionMap& view, const Eigen::Vector3f& point) {
    return view.map.pose.to_camera(point.cast<double>()).cast<float>();
  }

  bool same_normal(std::uint32_t asking, std::uint32_t pixel) const {
    if (reference_.normal.empty() || neighbour_.normal.empty()) return true;
    const Eigen::Vector3f& mine = reference_.normal[asking];
    const Eigen::Vector3f& other = neighbour_.normal[pixel];
    return mine.isZero(0) || other.isZero(0) || mine.dot(other) > least_cosine_;
  }

  const FusionMap& reference_;
  const FusionMap& neighbour_;
  const Camera& camera_;
  int width_, height_;
  float depth_threshold_, least_cosine_;
};

}  // namespace

FusionMap make_fusion_map(DepthMap map, cv::Mat3b color) {
  check(map, color);
  if (map.normal.empty()) map.normal = estimate_map_normals(map);
  FusionMap view;
  view.map = std::move(map);
  // Pixels are addressed as one run.
  if (!view.map.depth.isContinuous()) view.map.depth = view.map.depth.clone();
  view.color = color.isContinuous() ? color : cv::Mat3b(color.clone());
  const std::size_t pixels = view.map.depth.total();
  view.point.assign(pixels, Eigen::Vector3f::Zero());
  view.normal.assign(pixels, Eigen::Vector3f::Zero());
  view.weight.assign(pixels, 0.0f);
  std::visit(
      [&](const auto& camera) {
        parallel_for(static_cast<std::size_t>(view.map.height()),
                     [&](std::size_t y) { back_project_row(camera, static_cast<int>(y), view); });
      },
      make_camera<double>(view.map.camera));
  return view;
}

void ask_neighbour(const FusionMap& reference, const FusionMap& neighbour,
                   std::span<const std::uint32_t> asking, const FuseOptions& options,
                   std::span<Answer> answers) {
  std::visit(
      [&](const auto& camera) {
        const Neighbour ask(reference, neighbour, camera, options);
        constexpr std::size_t kGrain = 4096;
        parallel_for(
            asking.size(), [&](std::size_t i) { answers[i] = ask(asking[i]); }, kGrain);
      },
      make_camera<float>(neighbour.map.camera));
}

}  // namespace axial::cloud
