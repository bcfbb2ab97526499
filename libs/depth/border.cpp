// SPDX-License-Identifier: GPL-3.0-or-later
#include "depth/border.h"

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "depth/views/ray_caster.h"
#include "depth/views/warp.h"
#include "scene/camera_list.h"

namespace axial::depth {
namespace {

bool inside(const Eigen::Vector2f& pixel, cv::Size size) {
  const float right = static_cast<float>(size.width - 1) - pixel.x();
  const float below = static_cast<float>(size.height - 1) - pixel.y();
  return std::min({pixel.x(), pixel.y(), right, below}) >= kBorderWidth;
}

template <class Camera>
struct Source {
  Camera camera;
  RelativePose from_reference;
  cv::Size size;

  // True if the view shows the point [reference camera's frame] away from its border.
  bool shows_inside(const Eigen::Vector3f& point) const {
    const auto image = camera.project(from_reference.apply(point));
    return image.visible && inside(image.pixel, size);
  }
};

std::vector<CameraModel> models_of(const MatchInput& input) {
  std::vector<CameraModel> models{input.reference->camera};
  for (const MatchImage* source : input.sources) models.push_back(source->camera);
  return models;
}

template <class Camera>
std::vector<Source<Camera>> sources_of(const MatchInput& input,
                                       const std::vector<Camera>& cameras) {
  std::vector<Source<Camera>> sources;
  for (std::size_t i = 0; i < input.sources.size(); ++i) {
    const MatchImage& source = *input.sources[i];
    sources.push_back({cameras[i + 1], {input.reference->pose, source.pose}, source.grey.size()});
  }
  return sources;
}

enum class Block : std::uint8_t { kEmpty, kInside, kAtBorder };

}  // namespace

cv::Mat1b border_pixels(const MatchInput& input, const DepthMap& map) {
  cv::Mat1b border(map.depth.size(), std::uint8_t{0});
  const auto find = [&](const auto& cameras) {
    const auto sources = sources_of(input, cameras);
    std::vector<Block> blocks;  // of the current rows
    each_ray(cameras[0], map.width(), map.height(), [&](int x, int y, const auto& ray) {
      if (x == 0 && y % kBorderBlock == 0)
        blocks.assign(static_cast<std::size_t>(map.width() / kBorderBlock + 1), Block::kEmpty);
      const float depth = map.depth(y, x);
      if (!(depth > 0)) return;
      Block& block = blocks[static_cast<std::size_t>(x / kBorderBlock)];
      if (block == Block::kEmpty) {
        const Eigen::Vector3f point = ray.at(depth);
        const bool shown = std::ranges::any_of(
            sources, [&](const auto& source) { return source.shows_inside(point); });
        block = shown ? Block::kInside : Block::kAtBorder;
      }
      const Eigen::Vector2f pixel(static_cast<float>(x), static_cast<float>(y));
      if (block == Block::kAtBorder || !inside(pixel, map.depth.size())) border(y, x) = 255;
    });
  };
  std::visit(find, make_camera_list<float>(models_of(input), input.projection));
  return border;
}

}  // namespace axial::depth
