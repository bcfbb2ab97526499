// SPDX-License-Identifier: GPL-3.0-or-later
#include "cloud/two_views.h"

#include <cmath>

#include "scene/camera_model.h"

namespace axial::cloud {
namespace {

constexpr int kNeighbourReach = 2;
constexpr int kLeastOnPlane = 4;
constexpr int kMostOffPlane = 3;

}  // namespace

std::optional<std::size_t> undisputed_witness(std::span<const std::vector<Answer>> answers,
                                              std::size_t i) {
  std::optional<std::size_t> witness;
  for (std::size_t n = 0; n < answers.size(); ++n) {
    const Answer answer = answers[n][i];
    if (answer.cannot_see()) continue;
    if (!answer.names_pixel() || !answer.agrees()) return {};
    if (!witness) witness = n;
  }
  return witness;
}

SurfacePieces::SurfacePieces(const FusionMap& map, float max_distance)
    : map_(map),
      camera_(make_camera<float>(map.camera)),
      to_camera_(map.pose.rotation.cast<float>()),
      max_distance_(max_distance) {}

bool SurfacePieces::around(std::uint32_t pixel) const {
  const Eigen::Vector3f normal = to_camera_ * map_.normal_at(pixel);
  if (normal.isZero(0)) return false;
  const int x = static_cast<int>(pixel) % map_.depth.cols;
  const int y = static_cast<int>(pixel) / map_.depth.cols;
  return std::visit([&](const auto& camera) { return enough_on_plane(camera, x, y, normal); },
                    camera_);
}

template <class Camera>
bool SurfacePieces::enough_on_plane(const Camera& camera, int x, int y,
                                    const Eigen::Vector3f& normal) const {
  const auto height = [&](int u, int v) {
    const auto ray = camera.ray({static_cast<float>(u), static_cast<float>(v)});
    return normal.dot(ray.at(map_.depth(v, u)));
  };
  const float here = height(x, y), max_distance = max_distance_ * map_.depth(y, x);
  int on = 0, off = 0;
  for (int v = y - kNeighbourReach; v <= y + kNeighbourReach; v += kNeighbourReach)
    for (int u = x - kNeighbourReach; u <= x + kNeighbourReach; u += kNeighbourReach) {
      if ((u == x && v == y) || u < 0 || v < 0 || u >= map_.depth.cols || v >= map_.depth.rows)
        continue;
      if (!(map_.depth(v, u) > 0)) continue;
      ++(std::abs(height(u, v) - here) < max_distance ? on : off);
    }
  return on >= kLeastOnPlane && off <= kMostOffPlane;
}

}  // namespace axial::cloud
