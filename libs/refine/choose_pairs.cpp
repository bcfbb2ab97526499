// SPDX-License-Identifier: GPL-3.0-or-later
#include "refine/choose_pairs.h"

#include <algorithm>
#include <numbers>
#include <set>

#include "scene/view_selection.h"

namespace axial::refine {
namespace {

constexpr std::size_t kSamples = 20'000;

SparsePoint sample_point(const Mesh& mesh, const ScaledViews& views, const Visibility& visibility,
                         std::size_t vertex) {
  SparsePoint point{mesh.vertices[vertex], {}};
  for (std::size_t i = 0; i < views.count(); ++i)
    if (visibility.seen(vertex, i)) point.views.push_back({static_cast<std::uint32_t>(i), 0});
  return point;
}

Scene scene_of(const Mesh& mesh, const ScaledViews& views, const Visibility& visibility) {
  Scene scene;
  for (std::size_t i = 0; i < views.count(); ++i) {
    SceneImage image;
    image.calibrated = views.used(i);
    image.camera = views.view(i).camera;
    image.pose = views.view(i).pose;
    scene.images.push_back(std::move(image));
  }
  const std::size_t step = std::max<std::size_t>(1, mesh.vertices.size() / kSamples);
  for (std::size_t v = 0; v < mesh.vertices.size(); v += step)
    scene.points.push_back(sample_point(mesh, views, visibility, v));
  return scene;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> choose_pairs(const Mesh& mesh,
                                                              const ScaledViews& views,
                                                              const Visibility& visibility,
                                                              unsigned max_views) {
  constexpr double kDegree = std::numbers::pi / 180;
  ViewSelectionOptions options;
  options.min_area = 0.1;
  options.min_angle = 2.5 * kDegree;
  options.max_angle = 45 * kDegree;
  options.max_views = max_views;
  Scene scene = scene_of(mesh, views, visibility);
  score_neighbours(scene, options);
  std::set<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t i = 0; i < scene.images.size(); ++i) {
    const auto neighbours = filter_neighbours(scene.images[i].neighbours, options);
    for (const ViewScore& partner : choose_source_views(neighbours, max_views, options))
      pairs.insert(std::minmax<std::size_t>(i, partner.image));
  }
  return {pairs.begin(), pairs.end()};
}

}  // namespace axial::refine
